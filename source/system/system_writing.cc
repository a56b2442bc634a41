// SPDX-License-Identifier: GPL-3.0-or-later

#include "system_format.h"

#include <squeal/base/text.h>
#include <squeal/linear_algebra/matrix_market.h>
#include <squeal/system/system_file.h>

#include <nlohmann/json.hpp>

#include <map>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;
  }

  static std::string matrix_market_array(const DenseMatrix &A)
  {
    std::ostringstream content;
    content << "%%MatrixMarket matrix array real general\n" << A.rows() << ' ' << A.cols() << '\n';
    for (const double entry : A.reshaped())
      content << exact_text(entry) << '\n';
    return content.str();
  }

  void write_system(const std::vector<Term> &terms, const ParameterValues &weights, const SystemNotes &notes, const WriteFile &write)
  {
    Json json = {{"format", system_format}, {"version", system_format_version}};
    if (!notes.description.empty())
      json["description"] = notes.description;
    json["parameters"] = Json::object();
    for (const FileParameter &parameter : notes.parameters)
      {
        Json &entry = json["parameters"][parameter.name];
        entry       = {{"value", parameter.value}, {"lower", parameter.lower}, {"upper", parameter.upper}, {"unit", parameter.unit}};
        if (!parameter.description.empty())
          entry["description"] = parameter.description;
      }

    const auto write_text = [&](const std::string &name, const std::string &content) {
      write(name, [&content](std::ostream &stream) { stream << content; });
    };
    std::map<const void *, std::string> names; // file names of matrices and factors that have been written
    const auto                          factor_file = [&](const LowRankFactor &factor) {
      std::string &name = names[&factor];
      if (name.empty())
        {
          name               = text("factor_", names.size(), ".mtx");
          const auto &sparse = factor.sparse_transpose();
          if (sparse)
            write_text(name, matrix_market(*transpose(*sparse)));
          else
            {
              const MultiVector columns    = factor.columns(0, factor.rank());
              const RowMap      column_map = RowMap::even(factor.rank(), columns.map().communicator());
              write_text(name, matrix_market(SparseMatrix(columns.map(), column_map, [&](const int i, SparseMatrix::Row &row) {
                           for (int j = 0; j < columns.n_columns(); ++j)
                             row.emplace_back(j, columns(i, j));
                         })));
            }
        }
      return name;
    };
    json["terms"] = Json::array();
    for (const Term &term : terms)
      {
        Json entry = {{"name", term.name}, {"power", term.power}, {"coefficient", term.coefficient.text()}};
        if (term.matrix)
          {
            std::string &name = names[term.matrix.get()];
            if (name.empty())
              {
                name = text("matrix_", json["terms"].size() + 1, ".mtx");
                write_text(name, matrix_market(*term.matrix, term.symmetry == Symmetry::symmetric ? MatrixMarketSymmetry::symmetric :
                                                                                                    MatrixMarketSymmetry::general));
              }
            entry["matrix"]   = name;
            entry["symmetry"] = term.symmetry == Symmetry::symmetric ? "symmetric" : "skew";
          }
        else
          {
            entry["left"]  = factor_file(*term.left);
            entry["right"] = factor_file(*term.right);
            if (!term.weights.empty())
              {
                const std::string          name = text("weights_", json["terms"].size() + 1, ".mtx");
                const std::vector<double> &d    = weights.at(term.weights);
                write_text(name, matrix_market_array(d.empty() ? DenseMatrix::Zero(term.left->rank(), 1) : DenseMatrix(as_column(d))));
                entry["weights"] = name;
              }
          }
        entry["kind"] = to_string(term.kind);
        json["terms"].push_back(entry);
      }
    for (const DofGroup &group : notes.groups)
      for (const auto &[first, last] : group.ranges)
        json["groups"][group.name].push_back({first + 1, last + 1});
    if (notes.points)
      {
        json["positions"]     = "positions.mtx";
        json["displacements"] = "displacements.mtx";
        write_text("positions.mtx", matrix_market_array(notes.points->positions));
        write_text("displacements.mtx", matrix_market(*notes.points->displacements));
      }
    if (notes.reduction)
      json["reduction"] = {{"basis", notes.reduction->basis},
                           {"points", notes.reduction->points},
                           {"tolerance", notes.reduction->tolerance}};
    write_text("system.json", json.dump(2) + "\n");
  }
} // namespace Squeal
