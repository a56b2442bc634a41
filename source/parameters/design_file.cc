// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/parameters/csv_file.h>
#include <squeal/parameters/design_plan.h>

namespace Squeal
{
  std::string designs_file(const Parameters &parameters)
  {
    const DesignParameters &designs = parameters.designs;
    return designs.choice != DesignChoice::file || designs.file.empty() ? "" : input_path(designs.file, parameters.geometry.directory);
  }

  DesignPlan read_design_file(const Parameters &parameters)
  {
    CsvFile file = read_csv(designs_file(parameters), "Designs/File", "design");
    return {std::move(file.names), std::move(file.rows), std::move(file.where_names), std::move(file.where)};
  }
} // namespace Squeal
