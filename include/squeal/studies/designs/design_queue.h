#pragma once

#include <squeal/studies/designs/design_results.h>

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Where an unfinished study of designs is kept: what identifies it, the reference modes, and the designs that are finished.
  class DesignStore
  {
  public:
    /**
     * @param folder of the unfinished study; made by the root process if it does not exist
     * @param key    text that names everything on which results depend
     *
     * All processes must call. Throws FileError if another study lies there, or something else.
     */
    DesignStore(const std::filesystem::path &folder, const std::string &key, MPI_Comm communicator);

    /// For a process that solves designs of the study that is kept there.
    explicit DesignStore(const std::filesystem::path &folder);

    /// Folder with the result of a design.
    std::filesystem::path folder_of(int design) const;

    /// Folder in which a process of its own writes what it finds of designs.
    std::filesystem::path folder_of(const std::vector<int> &designs) const;

    /// What has been found of a design; nothing if it is not finished.
    std::optional<DesignResult> find(int design) const;

    /// How many of some designs are finished.
    std::size_t n_known(const std::vector<int> &designs) const;

    /// Keeps what became of a design that no process of its own has finished.
    void keep(const DesignResult &result) const;

    /// Deletes everything. The root process must call.
    void remove() const;

    const std::filesystem::path folder;

    /// File with the result of one design, in its folder.
    static constexpr const char *result_file = "design.result";

    /// File with the modes by which designs are named, in the folder of the study.
    static constexpr const char *reference_file = "reference.modes";
  };

  /**
   * Solves designs in processes of their own (base/worker_process.h), several side by side. Whatever happens to one, its
   * result says so and the others go on.
   *
   * @param batches      numbers of designs that one process solves, one after the other; finished ones among them cost nothing
   * @param n_side_by_side processes of this MPI process at a time
   * @param arguments    of the command line, from which a process reads the designs
   * @param unfinished   result of a design without what is to be found
   * @param report       of a design that is finished
   */
  void solve_side_by_side(const std::vector<std::vector<int>>             &batches,
                          unsigned int                                     n_side_by_side,
                          const DesignStore                               &store,
                          const std::function<DesignResult(int)>          &unfinished,
                          const std::function<void(const DesignResult &)> &report,
                          const std::vector<std::string>                  &arguments);
} // namespace Squeal
