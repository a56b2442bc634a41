#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/output/chart_checkpoint.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <boost/serialization/string.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace Squeal
{
  namespace fs = std::filesystem;
  using dealii::Utilities::MPI::broadcast;

  namespace
  {
    /// First words of every key; the number after them is the version of the format.
    const std::string title             = "squeal sweep";
    constexpr int     version_of_format = 6;
  } // namespace

  std::string checkpoint_folder(const std::string &output)
  {
    // The last slash, of which there may be one, belongs to the name of the folder, not in it.
    return (fs::path(output) / "").lexically_normal().parent_path().string() + ".checkpoint";
  }

  /// A block of the basis of a part, all rows, or, without a block, one of its results.
  struct ChartCheckpoint::Record
  {
    std::string part;
    DenseMatrix block;
    int         line = 0;
    ChartPoint  point;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &part &block &line &point;
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
      checkpoint.on_root([&] { checkpoint.keep({name, {}, point.line, result}); });
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
      const DenseMatrix all = gather(block);
      checkpoint.on_root([&] { checkpoint.keep({name, all, 0, {}}); });
    }

  private:
    ChartCheckpoint  &checkpoint;
    const Contents   &contents; ///< empty on all processes but one
    const std::string name;
    const RowMap      rows;
  };

  ChartCheckpoint::ChartCheckpoint(const std::string &folder, const std::string &key, const MPI_Comm communicator)
    : folder(folder)
    , identity(title + ' ' + std::to_string(version_of_format) + '\n' + key)
    , communicator(communicator)
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

  std::string ChartCheckpoint::file(const int number) const
  {
    return (fs::path(folder) / text("found-", number)).string();
  }

  void ChartCheckpoint::open()
  {
    if (fs::exists(folder) && !fs::is_directory(folder))
      throw FileError("`" + folder + "` is a file, but an unfinished sweep is kept in a folder of that name", "file " + folder,
                      "choose another --output, or move the file");
    const fs::path key = fs::path(folder) / key_name;
    // A run may have ended before its key was there
    fs::remove(key.string() + ".incomplete");
    if (!fs::exists(folder) || fs::is_empty(folder))
      return;
    std::ifstream     stream(key);
    const std::string there{std::istreambuf_iterator<char>(stream), {}};
    if (there.rfind(title, 0) != 0)
      throw FileError("the folder `" + folder + "` holds files that are not those of an unfinished sweep", "folder " + folder,
                      "choose another --output, or empty the folder");
    if (there != identity)
      throw FileError("an unfinished sweep of other parameters, another mesh or another version of the program lies there: " +
                        first_difference(there, identity),
                      "folder " + folder,
                      "run it to the end with its own parameters, which stand in `" + key.string() +
                        "`; choose another --output; or delete the folder");
    while (read(file(n_records + 1)))
      ++n_records;
    for (const auto &[name, contents] : parts)
      n_results += static_cast<int>(contents.results.size());
  }

  bool ChartCheckpoint::read(const std::string &file)
  {
    std::ifstream           stream(file, std::ios::binary);
    const std::vector<char> packed{std::istreambuf_iterator<char>(stream), {}};
    if (packed.empty()) // the file is missing
      return false;
    Record record;
    try
      {
        record = dealii::Utilities::unpack<Record>(packed.cbegin(), packed.cend(), false);
      }
    catch (const std::exception &) // a loss of power has taken its end
      {
        return false;
      }
    Contents &contents = parts[record.part];
    if (record.block.cols() > 0)
      contents.blocks.push_back(std::move(record.block));
    else
      contents.results[{record.line, record.point.friction_coefficient}] = std::move(record.point);
    return true;
  }

  void ChartCheckpoint::keep(const Record &record)
  {
    if (n_records == 0)
      {
        fs::create_directories(folder);
        replace_file(fs::path(folder) / key_name, identity);
      }
    const std::vector<char> packed = dealii::Utilities::pack(record, false);
    replace_file(file(n_records + 1), {packed.data(), packed.size()});
    ++n_records;
    // What lies behind a damaged record rests on one that is no longer
    fs::remove(file(n_records + 1));
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
