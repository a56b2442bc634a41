// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/base/worker_process.h>
#include <squeal/studies/designs/design_work.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <fstream>
#include <iterator>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr const char *key_file = "study.key";
    constexpr const char *title    = "squeal designs 4\n"; ///< includes the version of the format

    std::string content(const fs::path &file)
    {
      std::ifstream stream(file, std::ios::binary);
      return {std::istreambuf_iterator<char>(stream), {}};
    }

    void open(const fs::path &folder, const std::string &key)
    {
      const std::string name = folder.string();
      if (fs::exists(folder) && !fs::is_directory(folder))
        throw FileError("the folder for unfinished results cannot be created, because `" + name + "` is a file", "file " + name,
                        "choose another --output, or move the file");
      if (fs::exists(folder) && !fs::is_empty(folder))
        {
          const std::string there = content(folder / key_file);
          if (there.rfind("squeal designs", 0) != 0)
            throw FileError("the folder for unfinished results `" + name + "` is not empty and contains no unfinished study",
                            "folder " + name, "choose another --output, or empty the folder");
          if (there != title + key)
            throw FileError(
              "the folder contains an unfinished study with other parameters, another model or another version of the program: " +
                first_difference(there, title + key),
              "folder " + name,
              "finish that study with the version, parameters and model listed in `" + (folder / key_file).string() +
                "`, choose another --output, or delete the folder");
        }
      fs::create_directories(folder);
      replace_file(folder / key_file, title + key);
    }

    /// A process that solves designs in turn.
    struct Worker
    {
      std::vector<int>               designs; ///< all designs of this worker
      std::vector<int>               left;    ///< designs that have no result yet
      std::unique_ptr<WorkerProcess> process;
      Stopwatch                      stopwatch;
    };

    std::string list_of(const std::vector<int> &numbers)
    {
      std::string result;
      for (const int number : numbers)
        result += (result.empty() ? "" : ",") + std::to_string(number);
      return result;
    }
  } // namespace

  std::string checkpoint_folder(const std::string &output)
  {
    // Remove a trailing slash, so that the checkpoint is next to the folder of results, not in it
    return (fs::path(output) / "").lexically_normal().parent_path().string() + ".checkpoint";
  }

  Checkpoint::Checkpoint(const fs::path &folder, const std::string &key, const MPI_Comm communicator)
    : folder(folder)
  {
    std::vector<std::string> problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          open(folder, key);
          is_creator = true;
        }
      catch (const FileError &error)
        {
          problem = {error.reason, error.where, error.change};
        }
      catch (const fs::filesystem_error &error)
        {
          problem = {"the results of the study cannot be stored: " + error.code().message(), "folder " + folder.string(),
                     "check permissions and free space"};
        }
    problem = dealii::Utilities::MPI::broadcast(communicator, problem, 0);
    if (!problem.empty())
      throw FileError(problem[0], problem[1], problem[2]);
  }

  Checkpoint::Checkpoint(const fs::path &folder)
    : folder(folder)
  {}

  Checkpoint::~Checkpoint()
  {
    std::error_code ignored;
    if (is_creator && fs::directory_iterator(folder, ignored) != fs::directory_iterator() &&
        std::next(fs::directory_iterator(folder, ignored)) == fs::directory_iterator())
      fs::remove_all(folder, ignored);
  }

  void Checkpoint::write(const std::string &name, const std::vector<char> &packed) const
  {
    replace_file(folder / name, {packed.data(), packed.size()});
  }

  std::vector<char> Checkpoint::read(const std::string &name) const
  {
    const std::string packed = content(folder / name);
    return {packed.begin(), packed.end()};
  }

  static std::string file_of(const int design)
  {
    return text("design-", design, ".result");
  }

  fs::path DesignStore::folder_of(const std::vector<int> &designs) const
  {
    return folder / text(designs.size() == 1 ? "design-" : "designs-from-", designs.front());
  }

  std::optional<DesignResult> DesignStore::find(const int design) const
  {
    return Checkpoint::find<DesignResult>(file_of(design));
  }

  std::size_t DesignStore::n_known(const std::vector<int> &designs) const
  {
    return std::count_if(designs.begin(), designs.end(), [&](const int design) { return find(design).has_value(); });
  }

  void DesignStore::keep(const DesignResult &result) const
  {
    Checkpoint::keep(file_of(result.number), result);
  }

  void solve_side_by_side(const std::vector<std::vector<int>>             &batches,
                          const unsigned int                               n_side_by_side,
                          const DesignStore                               &store,
                          const std::function<DesignResult(int)>          &unfinished,
                          const std::function<void(const DesignResult &)> &report,
                          const std::vector<std::string>                  &given)
  {
    const auto start = [&](const std::vector<int> &designs, const std::vector<int> &left) {
      const fs::path           folder    = store.folder_of(designs);
      std::vector<std::string> arguments = given;
      arguments.push_back("--designs=" + list_of(designs));
      arguments.push_back("--output=" + folder.string());
      return Worker{designs,
                    left,
                    std::make_unique<WorkerProcess>(arguments, folder.string() + ".log", std::max(1u, n_usable_cores() / n_side_by_side)),
                    {}};
    };
    const auto report_found = [&](Worker &worker) {
      const auto is_found = [&](const int design) {
        const std::optional<DesignResult> result = store.find(design);
        if (result)
          report(*result);
        return result.has_value();
      };
      worker.left.erase(std::remove_if(worker.left.begin(), worker.left.end(), is_found), worker.left.end());
    };
    /// Marks the next design of a process that ended early as failed.
    const auto blame_next = [&](Worker &worker, const std::string &end) {
      DesignResult result = unfinished(worker.left.front());
      result.reason       = end.empty() ? "its process ended without a result" : "its process ended early: " + end;
      result.seconds      = worker.stopwatch.cost().seconds;
      store.keep(result);
      report(result);
      worker.left.erase(worker.left.begin());
    };

    std::vector<Worker> workers;
    for (auto next = batches.begin(); next != batches.end() || !workers.empty();)
      {
        for (; next != batches.end() && workers.size() < n_side_by_side; ++next)
          {
            std::vector<int> left;
            std::copy_if(next->begin(), next->end(), std::back_inserter(left), [&](const int design) { return !store.find(design); });
            if (!left.empty())
              workers.push_back(start(*next, left));
          }
        for (auto worker = workers.begin(); worker != workers.end();)
          {
            const auto end = worker->process->end();
            report_found(*worker);
            if (!end)
              {
                ++worker;
                continue;
              }
            if (!worker->left.empty())
              blame_next(*worker, *end);
            if (worker->left.empty())
              worker = workers.erase(worker);
            else
              {
                *worker = start(worker->designs, worker->left);
                ++worker;
              }
          }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
  }
} // namespace Squeal
