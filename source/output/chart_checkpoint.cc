#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/output/chart_checkpoint.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <Epetra_Comm.h>
#include <boost/serialization/string.hpp>
#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <string_view>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr const char *csv_header =
      "line [-],mu [-],frequency [Hz],growth rate [1/s],divergence rate [%],estimated error of lambda [-]\n";

    /// As many as a Table has on disk.
    constexpr int significant_digits = 12;

    /// Ending of a file that is being written.
    constexpr const char *incomplete = ".incomplete";

    constexpr const char *block_prefix = "basis_", *result_prefix = "line_", *binary = ".bin";

    /// The three parts of a FileError, on the way to all processes.
    struct Problem
    {
      std::string what, where, change;
    };

    /// A result with all that tells where it belongs.
    struct KeptResult
    {
      int        line = 0;
      double     friction_coefficient = 0.;
      int        n_blocks = 0; ///< of the basis in which its coordinates are
      ChartPoint point;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &line &friction_coefficient &n_blocks &point;
      }
    };

    // ------------------------------------------------------------------- files

    [[noreturn]] void fail(const std::string &what, const fs::path &file, const int reason)
    {
      throw Problem{what + ": " + std::strerror(reason), "file " + file.string(),
                    "check permissions and free space; then the same run continues from what it has kept"};
    }

    /// Writes to the disk itself: a file must not lose its content after those that rest on it have been written.
    void write(const fs::path &file, const int flags, const std::initializer_list<std::string_view> &parts)
    {
      if (const int reason = write_file(file, flags, parts, true); reason != 0)
        fail("what the sweep has found cannot be kept", file, reason);
    }

    /// The file has its old content or all of the new one, whatever happens.
    void replace(const fs::path &file, const std::initializer_list<std::string_view> &parts)
    {
      const fs::path  temporary = file.string() + incomplete;
      std::error_code problem;
      try
        {
          write(temporary, O_TRUNC, parts);
        }
      catch (const Problem &)
        {
          fs::remove(temporary, problem);
          throw;
        }
      fs::rename(temporary, file, problem);
      if (problem)
        fail("what the sweep has found cannot be kept", file, problem.value());
    }

    std::vector<char> content(const fs::path &file)
    {
      std::ifstream stream(file, std::ios::binary | std::ios::ate);
      if (!stream)
        fail("what an unfinished sweep has kept cannot be read", file, errno);
      const std::streamoff size = stream.tellg();
      std::vector<char>    result(std::max<std::streamoff>(size, 0));
      stream.seekg(0);
      if (size < 0 || !stream.read(result.data(), size))
        fail("what an unfinished sweep has kept cannot be read", file, EIO);
      return result;
    }

    // ------------------------------------------------------------ binary files

    /// FNV-1a, 64 bits.
    std::uint64_t checksum(const std::string_view bytes)
    {
      std::uint64_t hash = 0xcbf29ce484222325ull;
      for (const char byte : bytes)
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
      return hash;
    }

    /// Tells a complete file from a damaged one before boost reads it, which would take any number for a size.
    std::string header_of(const std::string_view body)
    {
      std::ostringstream text;
      text << "squeal sweep 1 " << body.size() << ' ' << std::hex << std::setfill('0') << std::setw(16) << checksum(body) << '\n';
      return text.str();
    }

    template <typename T>
    void save(const fs::path &file, const T &object)
    {
      const std::vector<char> packed = dealii::Utilities::pack(object, false);
      const std::string_view  body(packed.data(), packed.size());
      replace(file, {header_of(body), body});
    }

    /// Nothing if the file is damaged.
    template <typename T>
    std::optional<T> load(const fs::path &file)
    {
      const std::vector<char> bytes = content(file);
      const auto              end   = std::find(bytes.begin(), bytes.end(), '\n');
      if (end == bytes.end())
        return {};
      const std::string_view all(bytes.data(), bytes.size()), body = all.substr(end + 1 - bytes.begin());
      if (all.substr(0, all.size() - body.size()) != header_of(body))
        return {};
      try
        {
          return dealii::Utilities::unpack<T>(end + 1, bytes.end(), false);
        }
      catch (const boost::archive::archive_exception &)
        {
          return {};
        }
    }

    // -------------------------------------------------------------------- names

    fs::path block_file(const std::string &folder, const int number)
    {
      std::ostringstream name;
      name << block_prefix << std::setfill('0') << std::setw(4) << number << binary;
      return fs::path(folder) / name.str();
    }

    /// With all bits of the friction coefficient. Names sort by line and friction coefficient.
    fs::path result_file(const std::string &folder, const OperatingPoint &point)
    {
      const double  mu = point.friction_coefficient + 0.; // no minus zero
      std::uint64_t bits;
      static_assert(sizeof(bits) == sizeof(mu));
      std::memcpy(&bits, &mu, sizeof(bits));
      std::ostringstream name;
      name << result_prefix << std::setfill('0') << std::setw(4) << point.line << "_mu_" << std::hex << std::setw(16) << bits << binary;
      return fs::path(folder) / name.str();
    }

    /// Files of the folder whose names begin and end so, sorted.
    std::vector<fs::path> files(const fs::path &folder, const std::string &prefix, const std::string &ending)
    {
      std::vector<fs::path> result;
      for (const auto &entry : fs::directory_iterator(folder))
        {
          const std::string name = entry.path().filename().string();
          if (name.size() >= prefix.size() + ending.size() && name.compare(0, prefix.size(), prefix) == 0 &&
              name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
            result.push_back(entry.path());
        }
      std::sort(result.begin(), result.end());
      return result;
    }

    // -------------------------------------------------------------------- texts

    /// Rows of `points.csv`.
    std::string csv_rows(const int line, const double friction, const ChartPoint &point, const double largest_frequency)
    {
      std::ostringstream text;
      text << std::setprecision(significant_digits);
      for (std::size_t j = 0; j < point.lambda.size(); ++j)
        if (point.lambda[j].imag() <= largest_frequency)
          {
            const ModalQuantities mode = modal_quantities(point.lambda[j]);
            text << line << ',' << friction << ',' << mode.frequency << ',' << mode.growth_rate << ',' << 100. * mode.divergence_rate << ','
                 << point.errors[j] << '\n';
          }
      return text.str();
    }

    /// Where two texts differ first, for a message.
    std::string first_difference(const std::string &there, const std::string &here)
    {
      std::istringstream a(there), b(here);
      std::string        old_line, new_line;
      while (true)
        {
          const bool has_old = static_cast<bool>(std::getline(a, old_line)), has_new = static_cast<bool>(std::getline(b, new_line));
          if (!has_old || !has_new || old_line != new_line)
            {
              const auto quoted = [](const bool exists, const std::string &line) {
                const auto first = line.find_first_not_of(" \t");
                return exists && first != std::string::npos ? "`" + line.substr(first) + "`" : std::string("nothing");
              };
              return quoted(has_old, old_line) + " there, " + quoted(has_new, new_line) + " here";
            }
        }
    }
  } // namespace

  std::string checkpoint_folder(const std::string &output)
  {
    // The last slash, of which there may be one, belongs to the name of the folder, not in it.
    return (fs::path(output) / "").lexically_normal().parent_path().string() + ".checkpoint";
  }

  ChartCheckpoint::ChartCheckpoint(const std::string &folder,
                                   const std::string &key,
                                   const Epetra_Map  &rows,
                                   const MPI_Comm     communicator,
                                   const double       largest_frequency)
    : folder(folder)
    , rows(rows)
    , communicator(communicator)
    , is_root(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , largest_frequency(largest_frequency)
  {
    on_root([&] { open(key); });
    n_blocks  = dealii::Utilities::MPI::broadcast(communicator, n_blocks, 0);
    n_results = dealii::Utilities::MPI::broadcast(communicator, n_results, 0);
  }

  void ChartCheckpoint::on_root(const std::function<void()> &action) const
  {
    std::vector<std::string> problem;
    if (is_root)
      try
        {
          action();
        }
      catch (const Problem &error)
        {
          problem = {error.what, error.where, error.change};
        }
      catch (const fs::filesystem_error &error)
        {
          problem = {"what the sweep has found cannot be kept: " + error.code().message(), "folder " + folder,
                     "choose a folder that you may write to"};
        }
      catch (const std::exception &error)
        {
          // The other processes wait for an answer in any case.
          problem = {std::string("what the sweep has found cannot be kept: ") + error.what(), "folder " + folder, "check free memory and space"};
        }
    problem = dealii::Utilities::MPI::broadcast(communicator, problem, 0);
    if (!problem.empty())
      throw FileError(problem[0], problem[1], problem[2]);
  }

  void ChartCheckpoint::open(const std::string &key)
  {
    const fs::path place = folder, key_path = place / key_file;
    if (fs::exists(place) && !fs::is_directory(place))
      throw Problem{"`" + folder + "` is a file, but an unfinished sweep is kept in a folder of that name", "file " + folder,
                    "choose another --output, or move the file"};
    fs::create_directories(place);
    // A run may end before its key is there.
    fs::remove(key_path.string() + incomplete);
    if (fs::is_empty(place))
      replace(key_path, {key});
    if (!fs::exists(key_path))
      throw Problem{"the folder `" + folder + "` holds files that are not those of an unfinished sweep", "folder " + folder,
                    "choose another --output, or empty the folder"};
    const std::vector<char> bytes = content(key_path);
    const std::string       old_key(bytes.begin(), bytes.end());
    if (old_key != key)
      throw Problem{"an unfinished sweep of other parameters, or of another version of the program, lies there: " + first_difference(old_key, key),
                    "folder " + folder,
                    "run it to the end with its own parameters, which are in `" + key_path.string() +
                      "`; choose another --output; or delete the folder"};

    for (const fs::path &file : files(place, "", incomplete))
      fs::remove(file);
    const std::optional<int> found = read_blocks() ? read_results() : std::nullopt;
    if (found)
      n_results = *found;
    else
      start_afresh();
  }

  bool ChartCheckpoint::read_blocks()
  {
    const int n_files = static_cast<int>(files(folder, block_prefix, binary).size());
    for (n_blocks = 0; n_blocks < n_files; ++n_blocks)
      {
        const fs::path file = block_file(folder, n_blocks);
        if (!fs::exists(file))
          return false;
        const auto block = load<DenseMatrix>(file);
        if (!block || block->n_rows() != rows.NumGlobalElements() || block->n_columns() < 1)
          return false;
      }
    return true;
  }

  std::optional<int> ChartCheckpoint::read_results() const
  {
    std::string text = csv_header;
    int         n    = 0;
    for (const fs::path &file : files(folder, result_prefix, binary))
      {
        const auto kept = load<KeptResult>(file);
        if (!kept)
          fs::remove(file);
        else if (kept->n_blocks > n_blocks)
          return {};
        else
          {
            text += csv_rows(kept->line, kept->friction_coefficient, kept->point, largest_frequency);
            ++n;
          }
      }
    // Anew, as the last rows may not have been written, or not to their end.
    replace(fs::path(folder) / points_file, {text});
    return n;
  }

  void ChartCheckpoint::start_afresh()
  {
    // Results first: none may be left without the blocks on which it rests.
    for (const char *prefix : {result_prefix, block_prefix})
      for (const fs::path &file : files(folder, prefix, binary))
        fs::remove(file);
    n_blocks = n_results = 0;
    replace(fs::path(folder) / points_file, {csv_header});
  }

  int ChartCheckpoint::n_found() const
  {
    return n_results;
  }

  std::optional<ChartPoint> ChartCheckpoint::find(const OperatingPoint &point) const
  {
    std::vector<ChartPoint> found;
    on_root([&] {
      const fs::path file = result_file(folder, point);
      if (!fs::exists(file))
        return;
      if (auto kept = load<KeptResult>(file))
        found.push_back(std::move(kept->point));
    });
    found = dealii::Utilities::MPI::broadcast(communicator, found, 0);
    if (found.empty())
      return {};
    return found.front();
  }

  void ChartCheckpoint::keep(const OperatingPoint &point, const ChartPoint &result)
  {
    on_root([&] {
      const fs::path file     = result_file(folder, point);
      const bool     is_again = fs::exists(file);
      save(file, KeptResult{point.line, point.friction_coefficient, n_blocks, result});
      if (is_again)
        read_results();
      else
        write(fs::path(folder) / points_file, O_APPEND, {csv_rows(point.line, point.friction_coefficient, result, largest_frequency)});
    });
  }

  std::vector<MultiVector> ChartCheckpoint::basis() const
  {
    std::vector<MultiVector> result;
    result.reserve(n_blocks);
    for (int b = 0; b < n_blocks; ++b)
      {
        DenseMatrix all;
        int         n_columns = 0;
        on_root([&] {
          const fs::path file  = block_file(folder, b);
          auto           found = load<DenseMatrix>(file);
          if (!found)
            fail("what the sweep has kept was damaged meanwhile", file, EIO);
          all       = std::move(*found);
          n_columns = all.n_columns();
        });
        n_columns = dealii::Utilities::MPI::broadcast(communicator, n_columns, 0);
        MultiVector        &block = result.emplace_back(rows, n_columns, false);
        std::vector<double> column(rows.NumGlobalElements());
        // One column after the other: on the other processes there need not be room for all rows of a block.
        for (int j = 0; j < n_columns; ++j)
          {
            if (is_root)
              std::copy(all.column(j), all.column(j) + column.size(), column.begin());
            rows.Comm().Broadcast(column.data(), static_cast<int>(column.size()), 0);
            for (int i = 0; i < block.MyLength(); ++i)
              block[j][i] = column[rows.GID(i)];
          }
      }
    return result;
  }

  void ChartCheckpoint::keep(const MultiVector &block)
  {
    DenseMatrix all;
    if (is_root)
      all = DenseMatrix(block.GlobalLength(), block.NumVectors());
    for (int j = 0; j < block.NumVectors(); ++j)
      {
        const DenseMatrix column = replicate(view(block, j, 1));
        if (is_root)
          std::copy(column.column(), column.column() + column.n_rows(), all.column(j));
      }
    on_root([&] { save(block_file(folder, n_blocks), all); });
    ++n_blocks;
  }

  void ChartCheckpoint::remove()
  {
    on_root([&] { fs::remove_all(folder); });
  }
} // namespace Squeal
