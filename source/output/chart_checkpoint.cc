#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/output/chart_checkpoint.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <boost/serialization/string.hpp>

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string_view>

namespace Squeal
{
  namespace fs = std::filesystem;
  using dealii::Utilities::MPI::broadcast;

  namespace
  {
    /// First words of every archive; the number after them is the version of its format.
    const std::string title             = "squeal sweep";
    constexpr int     version_of_format = 5;

    constexpr const char *csv_header =
      "line [-],mu [-],frequency [Hz],growth rate [1/s],divergence rate [%],estimated error of lambda [-]\n";

    /// Stands before every record: the size and checksum of what follows, the size of its packed part, that part, the entries of a block.
    struct Head
    {
      std::uint64_t size = 0, checksum = 0;
    };

    /// CRC-32, fast beside what it takes to write; @p before continues that of what comes before.
    std::uint64_t record_checksum(const std::string_view bytes, const std::uint64_t before = 0)
    {
      // zlib takes a null pointer for a question about the initial value
      return bytes.empty() ? before : crc32_z(before, reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size());
    }

    std::string_view as_text(const std::vector<char> &record)
    {
      return {record.data(), record.size()};
    }

    template <typename Object>
    std::string_view bytes_of(const Object &object)
    {
      return {reinterpret_cast<const char *>(&object), sizeof(object)};
    }

    /// As many as a Table has on disk.
    constexpr int digits_of_numbers = 12;

    /// Rows of `points.csv`.
    std::string csv_rows(const int line, const ChartPoint &point, const double largest_circular_frequency)
    {
      std::ostringstream text;
      text << std::setprecision(digits_of_numbers);
      for (std::size_t j = 0; j < point.lambda.size(); ++j)
        if (point.lambda[j].imag() <= largest_circular_frequency)
          {
            const ModalQuantities mode = modal_quantities(point.lambda[j]);
            text << line << ',' << point.friction_coefficient << ',' << mode.frequency << ',' << mode.growth_rate << ','
                 << 100. * mode.divergence_rate << ',' << point.errors[j] << '\n';
          }
      return text.str();
    }
  } // namespace

  std::string checkpoint_folder(const std::string &output)
  {
    // The last slash, of which there may be one, belongs to the name of the folder, not in it.
    return (fs::path(output) / "").lexically_normal().parent_path().string() + ".checkpoint";
  }

  /// A block of the basis of a part, whose entries follow, or one of its results.
  struct ChartCheckpoint::Record
  {
    std::string  part;
    int          n_blocks;      ///< of the part before it, on which it rests
    Eigen::Index rows, columns; ///< of the block, all rows; none for a result
    int          line;
    ChartPoint   point;

    bool is_block() const
    {
      return columns > 0;
    }

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &part &n_blocks &rows &columns &line &point;
    }
  };

  class ChartCheckpoint::Part : public ChartStore
  {
  public:
    Part(ChartCheckpoint &checkpoint, const std::string &name, const RowMap &rows)
      : checkpoint(checkpoint)
      , contents(checkpoint.parts[name])
      , name(name)
      , rows(rows)
    {}

    std::optional<ChartPoint> find(const OperatingPoint &point) const override
    {
      const auto              place = contents.results.find({point.line, point.friction_coefficient});
      std::vector<ChartPoint> found;
      if (place != contents.results.end())
        found.push_back(place->second);
      found = broadcast(checkpoint.communicator, found, 0);
      return found.empty() ? std::optional<ChartPoint>() : found.front();
    }

    void keep(const OperatingPoint &point, const ChartPoint &result) override
    {
      checkpoint.on_root([&] { checkpoint.append({name, contents.n_blocks, 0, 0, point.line, result}, nullptr); });
    }

    std::vector<MultiVector> basis() const override
    {
      std::vector<MultiVector> result;
      const auto               n = broadcast(checkpoint.communicator, contents.blocks.size(), 0);
      for (std::size_t b = 0; b < n; ++b)
        result.push_back(scatter(b < contents.blocks.size() ? contents.blocks[b] : DenseMatrix(), rows));
      return result;
    }

    void keep(const MultiVector &block) override
    {
      // A process that has all rows needs no copy of them
      const bool        is_alone = rows.n_processes() == 1;
      const DenseMatrix all      = is_alone ? DenseMatrix() : gather(block);
      checkpoint.on_root([&] {
        checkpoint.append({name, contents.n_blocks, rows.n(), block.n_columns(), 0, {}}, is_alone ? block.local().data() : all.data());
      });
    }

  private:
    ChartCheckpoint  &checkpoint;
    Contents         &contents; ///< empty on all processes but one
    const std::string name;
    const RowMap      rows;
  };

  ChartCheckpoint::ChartCheckpoint(const std::string &folder,
                                   const std::string &key,
                                   const MPI_Comm     communicator,
                                   const double       largest_circular_frequency)
    : folder(folder)
    , identity(title + ' ' + std::to_string(version_of_format) + '\n' + key)
    , archive(fs::path(folder) / archive_name)
    , communicator(communicator)
    , largest_circular_frequency(largest_circular_frequency)
  {
    on_root([&] { open(); });
    n_results = broadcast(communicator, n_results, 0);
  }

  void ChartCheckpoint::on_root(const std::function<void()> &action) const
  {
    std::vector<std::string> problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          action();
        }
      catch (const FileError &error)
        {
          problem = {error.reason, error.where, error.change};
        }
      catch (const fs::filesystem_error &error)
        {
          problem = {"what the sweep has found cannot be kept: " + error.code().message(),
                     "folder " + folder + ", file " + error.path1().string(),
                     "check permissions and free space; then the same run continues from what it has kept"};
        }
      catch (const std::exception &error)
        {
          // The other processes wait for an answer in any case.
          problem = {std::string("what the sweep has found cannot be kept: ") + error.what(), "folder " + folder, "check free memory"};
        }
    problem = broadcast(communicator, problem, 0);
    if (!problem.empty())
      throw FileError(problem[0], problem[1], problem[2]);
  }

  void ChartCheckpoint::open()
  {
    if (fs::exists(folder) && !fs::is_directory(folder))
      throw FileError("`" + folder + "` is a file, but an unfinished sweep is kept in a folder of that name", "file " + folder,
                      "choose another --output, or move the file");
    // A run may have ended before its archive was there
    fs::remove(archive.string() + ".incomplete");
    if (!fs::exists(folder) || fs::is_empty(folder))
      return;
    std::string there; // what the archive begins with
    if (fs::exists(archive))
      {
        std::ifstream stream(archive, std::ios::binary);
        if (!stream)
          throw fs::filesystem_error("read", archive, std::error_code(errno, std::generic_category()));
        std::getline(stream, there, '\0');
      }
    if (there.rfind(title, 0) != 0)
      throw FileError("the folder `" + folder + "` holds files that are not those of an unfinished sweep", "folder " + folder,
                      "choose another --output, or empty the folder");
    if (there != identity)
      throw FileError("an unfinished sweep of other parameters, another mesh or another version of the program lies there: " +
                        first_difference(there, identity),
                      "folder " + folder,
                      "run it to the end with its own parameters, with which `" + archive.string() +
                        "` begins; choose another --output; or delete the folder");
    if (!read())
      parts.clear(); // the first record begins another archive
    is_begun         = !parts.empty();
    std::string text = csv_header;
    for (const auto &[name, contents] : parts)
      for (const auto &[place, result] : contents.results)
        {
          text += csv_rows(place.first, result, largest_circular_frequency);
          ++n_results;
        }
    replace_file(fs::path(folder) / points_name, text);
  }

  bool ChartCheckpoint::read()
  {
    bool                 is_complete = true;
    std::ifstream        stream(archive, std::ios::binary);
    const std::uintmax_t size = fs::file_size(archive);
    end                       = identity.size() + 1;
    stream.seekg(static_cast<std::streamoff>(end));
    for (Head head; end + sizeof(head) <= size; end += sizeof(head) + head.size)
      {
        stream.read(reinterpret_cast<char *>(&head), sizeof(head));
        if (stream && head.size > size - end - sizeof(head))
          break;
        std::vector<char> packed(stream ? head.size : 0);
        if (!stream.read(packed.data(), static_cast<std::streamsize>(packed.size())))
          throw fs::filesystem_error("read", archive, std::make_error_code(std::errc::io_error));
        if (record_checksum(as_text(packed)) != head.checksum)
          continue;
        std::uint64_t size_of_packed;
        std::memcpy(&size_of_packed, packed.data(), sizeof(size_of_packed));
        const auto begin = packed.cbegin() + sizeof(size_of_packed), entries = begin + static_cast<std::ptrdiff_t>(size_of_packed);
        Record     record   = dealii::Utilities::unpack<Record>(begin, entries, false);
        Contents  &contents = parts[record.part];
        is_complete         = is_complete && record.n_blocks == contents.n_blocks;
        if (record.is_block())
          {
            DenseMatrix block(record.rows, record.columns);
            std::memcpy(block.data(), &*entries, block.size() * sizeof(double));
            contents.blocks.push_back(std::move(block));
            ++contents.n_blocks;
          }
        else
          contents.results[{record.line, record.point.friction_coefficient}] = std::move(record.point);
      }
    fs::resize_file(archive, end);
    return is_complete;
  }

  void ChartCheckpoint::append(const Record &record, const double *block)
  {
    if (!is_begun)
      {
        fs::create_directories(folder);
        end = identity.size() + 1;
        replace_file(archive, {identity.c_str(), end});
        replace_file(fs::path(folder) / points_name, csv_header);
        is_begun = true;
      }
    const std::vector<char> packed = dealii::Utilities::pack(record, false);
    const std::string_view  entries{reinterpret_cast<const char *>(block), record.rows * record.columns * sizeof(double)};
    const std::uint64_t     size_of_packed = packed.size();
    const Head              head{sizeof(size_of_packed) + packed.size() + entries.size(),
                    record_checksum(entries, record_checksum(as_text(packed), record_checksum(bytes_of(size_of_packed))))};
    fs::resize_file(archive, end); // what an attempt that failed has left
    // The disk may take longer for a point than the model: a loss of power costs what the last second has found
    const auto   now     = std::chrono::steady_clock::now();
    const OnDisk on_disk = record.is_block() || now - last_on_disk > std::chrono::seconds(1) ? OnDisk::now : OnDisk::later;
    if (on_disk == OnDisk::now)
      last_on_disk = now;
    append_to_file(archive, {bytes_of(head), bytes_of(size_of_packed), as_text(packed), entries}, on_disk);
    end += sizeof(head) + head.size;
    if (record.is_block())
      ++parts[record.part].n_blocks;
    else
      append_to_file(fs::path(folder) / points_name, {csv_rows(record.line, record.point, largest_circular_frequency)}, OnDisk::later);
  }

  int ChartCheckpoint::n_found() const
  {
    return n_results;
  }

  std::unique_ptr<ChartStore> ChartCheckpoint::part(const std::string &name, const RowMap &rows)
  {
    return std::make_unique<Part>(*this, name, rows);
  }

  void ChartCheckpoint::remove()
  {
    on_root([&] { fs::remove_all(folder); });
  }
} // namespace Squeal
