#include <squeal/base/text.h>
#include <squeal/base/version.h>
#include <squeal/output/run_record.h>

#include <deal.II/base/config.h>

#include <Trilinos_version.h>
#include <cholmod.h>
#include <dmumps_c.h>
#include <gmsh.h>
#include <nlohmann/json.hpp>
#include <umfpack.h>

#include <ctime>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <thread>

namespace Squeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr const char *file_list = "files [byte]";

    /// Such as 2026-01-31T12:00:00Z.
    std::string utc_time()
    {
      const std::time_t  now = std::time(nullptr);
      std::ostringstream text;
      text << std::put_time(std::gmtime(&now), "%Y-%m-%dT%H:%M:%SZ");
      return text.str();
    }
  } // namespace

  void write_run_record(std::ostream &stream, const RunRecord &record, const Progress &progress)
  {
    Json tree;
    tree["command"]  = record.command;
    tree["finished"] = utc_time();
    tree["versions"] = {{"squeal", version},
                        {"revision", record.revision},
                        {"deal.II", DEAL_II_PACKAGE_VERSION},
                        {"Trilinos", TRILINOS_VERSION_STRING},
                        {"MUMPS", MUMPS_VERSION},
                        {"CHOLMOD", text(CHOLMOD_MAIN_VERSION, ".", CHOLMOD_SUB_VERSION, ".", CHOLMOD_SUBSUB_VERSION)},
                        {"UMFPACK", UMFPACK_VERSION},
                        {"Gmsh", GMSH_API_VERSION}};
    tree["machine"]  = {{"cores", std::thread::hardware_concurrency()},
                        {"processes", record.n_processes},
                        {"threads per process", record.n_threads},
                        {"BLAS threads per process", record.blas_threads}};
    for (const auto &[name, count] : record.counts)
      tree["counts"][name] = count;
    for (const auto &[name, value] : record.quantities)
      tree["quantities"][name] = value;
    tree["warnings"]      = record.warnings;
    tree["wall time [s]"] = progress.elapsed();
    for (const StepRecord &step : progress.steps())
      tree["steps"].push_back({{"name", step.name},
                               {"wall time [s]", step.seconds},
                               {"CPU time [s]", step.cpu_seconds},
                               {"peak memory so far [byte]", step.peak_memory},
                               {"result", step.summary}});
    tree[file_list] = record.files;
    // Names of files and words of a command need not be UTF-8.
    stream << tree.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  }

  std::optional<FileSizes> read_file_list(const std::filesystem::path &record)
  {
    std::ifstream stream(record);
    try
      {
        return Json::parse(stream).at(file_list).get<FileSizes>();
      }
    catch (const Json::exception &)
      {
        return {};
      }
  }
} // namespace Squeal
