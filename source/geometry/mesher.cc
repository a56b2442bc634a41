#include <squeal/base/exceptions.h>
#include <squeal/base/installation.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mesher.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace Squeal
{
  namespace
  {
    constexpr const char *repair       = "correct the geometry; opening it in Gmsh shows the place";
    constexpr const char *add_entities = "a .msh of format 4 must declare the entities of its elements, with their physical groups, in "
                                         "$Entities; write it with them, or in format 2.2";
    constexpr std::size_t quoted_lines = 8;

    [[noreturn]] void cannot_start(const int error)
    {
      throw FileError(std::string("The mesher cannot be started: ") + std::strerror(error), installation().mesher.string(),
                      "build or install squeal_mesher; check permissions and limits on processes");
    }

    /// An open file or end of a pipe, above the numbers that the mesher is given.
    class Descriptor
    {
    public:
      /// Takes over @p opened, the result of a call that opens a file or fails with errno.
      explicit Descriptor(const int opened)
      {
        constexpr int least = 10;
        number              = opened < 0 ? -1 : fcntl(opened, F_DUPFD_CLOEXEC, least);
        const int error     = errno;
        if (opened >= 0)
          close(opened);
        if (number < 0)
          cannot_start(error);
      }

      ~Descriptor()
      {
        close(number);
      }

      Descriptor(const Descriptor &)            = delete;
      Descriptor &operator=(const Descriptor &) = delete;

      int operator*() const
      {
        return number;
      }

    private:
      int number;
    };

    /// A file in memory, which vanishes with its last descriptor, has no name but this one.
    std::string name_of(const Descriptor &memory_file)
    {
      return "/proc/self/fd/" + std::to_string(*memory_file);
    }

    /// A process that runs Gmsh, from its start until it is waited for or killed.
    class MesherProcess
    {
    public:
      MesherProcess(const std::vector<std::string> &arguments, const std::vector<std::string> &environment, const std::string &script)
        : printed(memfd_create("gmsh.log", MFD_CLOEXEC))
      {
        int pipe_ends[2] = {-1, -1};
        if (pipe2(pipe_ends, O_CLOEXEC) != 0)
          cannot_start(errno);
        Descriptor writing(pipe_ends[1]);
        reply.emplace(pipe_ends[0]);
        const Descriptor script_file(memfd_create("driver.geo", MFD_CLOEXEC));
        if (!(std::ofstream(name_of(script_file)) << script << std::flush))
          cannot_start(errno);

        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        for (const auto &[from, to] :
             {std::make_pair(*printed, STDOUT_FILENO), std::make_pair(*printed, STDERR_FILENO),
              std::make_pair(*writing, mesher_reply_descriptor), std::make_pair(*script_file, mesher_script_descriptor)})
          posix_spawn_file_actions_adddup2(&actions, from, to);
        const int error =
          posix_spawn(&process, installation().mesher.c_str(), &actions, nullptr, pointers(arguments).data(), pointers(environment).data());
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0)
          cannot_start(error);
      }

      ~MesherProcess()
      {
        if (!is_over)
          {
            kill(process, SIGKILL);
            wait();
          }
      }

      MesherProcess(const MesherProcess &)            = delete;
      MesherProcess &operator=(const MesherProcess &) = delete;

      /// All that the process says until it ends; none where it has not ended in time.
      std::optional<std::string> read(const double seconds)
      {
        const auto        end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        std::string       all;
        std::vector<char> buffer(1 << 16);
        while (true)
          {
            const std::chrono::duration<double, std::milli> left = end - std::chrono::steady_clock::now();
            if (left.count() <= 0.)
              return {};
            pollfd    waiting{**reply, POLLIN, 0};
            const int longest_wait = 1000; // [ms]
            if (poll(&waiting, 1, std::min<double>(left.count() + 1., longest_wait)) <= 0)
              continue;
            const ssize_t n = ::read(**reply, buffer.data(), buffer.size());
            if (n == 0)
              return all;
            if (n > 0)
              all.append(buffer.data(), n);
          }
      }

      /// Its exit status as waitpid() gives it.
      int wait()
      {
        int status = 0;
        while (waitpid(process, &status, 0) < 0 && errno == EINTR)
          {}
        is_over = true;
        return status;
      }

      /// What Gmsh printed so far.
      std::string log() const
      {
        std::ifstream stream(name_of(printed));
        return {std::istreambuf_iterator<char>(stream), {}};
      }

    private:
      static std::vector<char *> pointers(const std::vector<std::string> &texts)
      {
        std::vector<char *> result;
        for (const std::string &text : texts)
          result.push_back(const_cast<char *>(text.c_str()));
        result.push_back(nullptr);
        return result;
      }

      pid_t                     process = 0;
      bool                      is_over = false;
      Descriptor                printed;
      std::optional<Descriptor> reply;
    };

    std::vector<std::string> environment(const bool is_confined)
    {
      std::vector<std::string> result;
      if (is_confined)
        {
          // Where the libraries are, and nothing else
          if (const char *path = std::getenv("LD_LIBRARY_PATH"))
            result.push_back(std::string("LD_LIBRARY_PATH=") + path);
          result.push_back("HOME=/dev/null"); // no preferences of the libraries, either; not even root can make a folder there
        }
      else
        for (char **variable = environ; *variable != nullptr; ++variable)
          result.push_back(*variable);
      return result;
    }

    /// A line of Gmsh, which may quote anything from a file: nothing that a terminal would obey, and not of any length.
    std::string shown(std::string line)
    {
      constexpr std::size_t longest_line = 500;
      if (line.size() > longest_line)
        line = line.substr(0, longest_line) + "...";
      std::replace_if(
        line.begin(), line.end(), [](const unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
      return line;
    }

    /// What Gmsh printed last, from the first error if there is one.
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
      return text.empty() ? "It printed nothing" : "Its log:" + text;
    }

    [[noreturn]] void refuse_memory(const MesherLimits &limits, const std::string &where)
    {
      throw MeshError("Gmsh needs more than " + exact_text(std::round(limits.bytes / 1e7) / 100.) + " GB for this geometry", where,
                      "use larger elements or fewer of them, or raise Geometry/Meshing memory limit");
    }

    /// What became of a process that said nothing.
    [[noreturn]] void explain_end(const int status, const std::string &log, const MesherLimits &limits, const std::string &where)
    {
      // Its allocator says so, and goes on without the memory
      if (log.find("Out of memory") != std::string::npos)
        refuse_memory(limits, where);
      if (WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS)
        throw ForbiddenAction("starts a program, writes a file or opens a connection");
      if (WIFSIGNALED(status))
        throw MeshError(std::string("Gmsh crashed (") + strsignal(WTERMSIG(status)) + "). " + quoted(log), where, repair);
      throw MeshError("The geometry ended Gmsh before there was a mesh. " + quoted(log), where, "remove Exit or Abort from the geometry");
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
      throw MeshError("The mesher gave an unknown reply", where, "build all of the program anew");
    }
  } // namespace

  GmshMesh run_mesher(const MesherInput &input, const std::string &where, const MesherLimits &limits)
  {
    std::vector<std::string> arguments = {installation().mesher.string(), input.file, exact_text(limits.bytes), exact_text(limits.seconds),
                                          limits.is_confined ? mesher_confined : mesher_free};
    for (const auto &[name, value] : input.numbers)
      arguments.insert(arguments.end(), {name, exact_text(value)});

    MesherProcess                    mesher(arguments, environment(limits.is_confined), input.script);
    const std::optional<std::string> reply = mesher.read(limits.seconds);
    if (!reply)
      throw MeshError("Gmsh did not finish within " + exact_text(limits.seconds) + " s", where,
                      "use larger elements, look for an endless loop in the geometry, or raise Geometry/Meshing time limit");
    const int status = mesher.wait();
    if (reply->empty())
      explain_end(status, mesher.log(), limits, where);
    try
      {
        return mesh_from(*reply, mesher.log(), limits, where);
      }
    catch (const std::length_error &)
      {
        explain_end(status, mesher.log(), limits, where); // the reply breaks off
      }
  }
} // namespace Squeal
