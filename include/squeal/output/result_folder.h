#pragma once

#include <functional>
#include <iosfwd>
#include <string>

namespace Squeal
{
  /**
   * The folder in which a run leaves its results. Everything is written into a
   * temporary folder beside it, which takes its name when the run is complete;
   * a run that fails leaves nothing and touches no earlier result. A folder
   * that is not the result of an earlier run is never replaced.
   */
  class ResultFolder
  {
  public:
    /**
     * @param directory name of the folder after commit()
     * @param is_root   process that creates, renames and removes
     *
     * Throws FileError if @p directory holds something other than results, or cannot be created.
     */
    ResultFolder(const std::string &directory, bool is_root);

    /// Removes the temporary folder unless committed.
    ~ResultFolder();

    ResultFolder(const ResultFolder &)            = delete;
    ResultFolder &operator=(const ResultFolder &) = delete;

    /// Where to write a file called @p name for now; creates its parent folders.
    std::string path(const std::string &name) const;

    /// Writes a text file on the root process; throws FileError if the disk is full.
    void write(const std::string &name, const std::function<void(std::ostream &)> &writer) const;

    /// Whether this process writes the files.
    bool writes_here() const;

    /// Gives the folder its name; an earlier result of that name is replaced.
    void commit();

    /// Name of the finished folder.
    const std::string &name() const;

    /// File that marks a folder as the result of a run.
    static constexpr const char *run_record = "run.json";

  private:
    std::string directory, temporary;
    bool        is_root, committed = false;
  };
} // namespace Squeal
