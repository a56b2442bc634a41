// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/installation.h>
#include <squeal/base/process.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mesher.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>

#include <sys/mman.h>
#include <sys/wait.h>

namespace Squeal
{
  namespace
  {
    constexpr const char *repair       = "correct the geometry; open it in Gmsh to locate the error";
    constexpr const char *add_entities = "in a .msh of format 4, declare the entities of all elements, with their physical groups, in "
                                         "$Entities, or write the mesh in format 2.2";
    constexpr std::size_t quoted_lines = 8;

    /// A file in memory that is removed when its last descriptor is closed.
    using MemoryFile = std::unique_ptr<std::FILE, decltype(&std::fclose)>;

    MemoryFile memory_file(const std::string &content)
    {
      MemoryFile result(fdopen(memfd_create("squeal", MFD_CLOEXEC), "w+"), std::fclose);
      if (!result)
        throw std::system_error(errno, std::generic_category(), "file in memory");
      std::fwrite(content.data(), 1, content.size(), result.get());
      std::rewind(result.get());
      return result;
    }

    std::string content_of(const MemoryFile &file)
    {
      std::string result(lseek(fileno(file.get()), 0, SEEK_END), ' ');
      std::rewind(file.get());
      result.resize(std::fread(result.data(), 1, result.size(), file.get()));
      return result;
    }

    process::environment environment(const bool is_confined)
    {
      if (!is_confined)
        return boost::this_process::environment();
      // Pass only the library path
      process::environment result;
      if (const char *path = std::getenv("LD_LIBRARY_PATH"))
        result["LD_LIBRARY_PATH"] = path;
      result["HOME"] = "/dev/null"; // prevents libraries from storing preferences: even root cannot create a folder there
      return result;
    }

    /// A line of Gmsh's output, truncated and without control characters, because it may quote arbitrary file contents.
    std::string shown(std::string line)
    {
      constexpr std::size_t longest_line = 500;
      if (line.size() > longest_line)
        line = line.substr(0, longest_line) + "...";
      std::replace_if(
        line.begin(), line.end(), [](const unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
      return line;
    }

    /// Up to `quoted_lines` lines of Gmsh's output: from the first error, or the last lines.
    std::string quoted(const std::string &log)
    {
      std::istringstream       stream(log);
      std::vector<std::string> lines;
      for (std::string line; std::getline(stream, line);)
        if (!line.empty())
          lines.push_back(line);
      const auto first_error =
        std::find_if(lines.begin(), lines.end(), [](const std::string &line) { return line.rfind("Error", 0) == 0; });
      std::size_t first = std::min<std::size_t>(first_error - lines.begin(), lines.size() - std::min(lines.size(), quoted_lines));
      std::string text;
      for (const std::size_t end = std::min(lines.size(), first + quoted_lines); first < end; ++first)
        text += "\n    | " + shown(lines[first]);
      return text.empty() ? "Gmsh printed nothing" : "Log of Gmsh:" + text;
    }

    [[noreturn]] void refuse_memory(const MesherLimits &limits, const std::string &where)
    {
      throw MeshError("Gmsh needs more than " + exact_text(std::round(limits.bytes / 1e7) / 100.) + " GB for this geometry", where,
                      "use larger or fewer elements, or raise Geometry/Meshing memory limit");
    }

    /// Throws the error for a process that ended without a reply.
    [[noreturn]] void explain_end(const int status, const std::string &log, const MesherLimits &limits, const std::string &where)
    {
      if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        throw MeshError("Gmsh did not finish within " + exact_text(limits.seconds) + " s", where,
                        "use larger elements, remove endless loops from the geometry, or raise Geometry/Meshing time limit");
      if (WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS)
        throw ForbiddenAction("starts a program, changes files or opens a connection");
      if (WIFSIGNALED(status))
        {
          // Gmsh 4.13 prints this message and crashes; 4.8 throws std::bad_alloc
          if (log.find("Out of memory") != std::string::npos)
            refuse_memory(limits, where);
          throw MeshError(std::string("Gmsh crashed (") + strsignal(WTERMSIG(status)) + "). " + quoted(log), where,
                          text(repair, ", or use larger elements if the machine ran out of memory"));
        }
      throw MeshError("Gmsh ended before the mesh was complete. " + quoted(log), where,
                      "remove Exit and Abort from the geometry, or repair the installation if the log names a missing library");
    }

    GmshMesh mesh_from(const std::string &reply, const std::string &log, const MesherLimits &limits, const std::string &where)
    {
      const std::string content = reply.substr(1);
      switch (static_cast<MesherReply>(reply[0]))
        {
          case MesherReply::mesh:
            return from_bytes(content);
          case MesherReply::failure:
            throw MeshError(content + ". " + quoted(log), where, log.find("Unknown entity") == std::string::npos ? repair : add_entities);
          case MesherReply::out_of_memory:
            refuse_memory(limits, where);
        }
      throw MeshError("The reply of squeal_mesher is unknown", where, "rebuild squeal and squeal_mesher from the same sources");
    }
  } // namespace

  GmshMesh run_mesher(const MesherInput &input, const std::string &where, const MesherLimits &limits)
  {
    std::vector<std::string> arguments = {input.file, exact_text(limits.bytes), exact_text(limits.seconds),
                                          limits.is_confined ? mesher_confined : mesher_free};
    for (const auto &[name, value] : input.numbers)
      arguments.insert(arguments.end(), {name, exact_text(value)});

    const MemoryFile  script = memory_file(input.script), printed = memory_file("");
    process::ipstream answer;
    std::string       reply;
    int               status = 0;
    try
      {
        process::child mesher(installation().mesher.string(), process::args(arguments), environment(limits.is_confined),
                              process::std_out > answer, process::std_err > printed.get(), process::std_in < script.get());
        reply.assign(std::istreambuf_iterator<char>(answer), {});
        mesher.wait();
        status = mesher.native_exit_code();
      }
    catch (const process::process_error &error)
      {
        throw FileError("The mesher cannot be started: " + error.code().message(), installation().mesher.string(),
                        "build or install squeal_mesher; check permissions and limits on processes");
      }
    const std::string log = content_of(printed);
    if (reply.empty())
      explain_end(status, log, limits, where);
    try
      {
        return mesh_from(reply, log, limits, where);
      }
    catch (const std::length_error &)
      {
        explain_end(status, log, limits, where); // the reply is incomplete
      }
  }
} // namespace Squeal
