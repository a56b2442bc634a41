// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/parameters/csv_file.h>
#include <squeal/studies/updating/sensors.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/predicate.hpp>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    constexpr const char *parameter_of_sensors = "Updating/Sensors";
    constexpr const char *imaginary            = " imaginary"; ///< suffix of columns with imaginary parts

    const std::vector<std::string> place_columns = {"x [m]", "y [m]", "z [m]", "direction x", "direction y", "direction z"};

    Eigen::VectorXd column(const CsvFile &file, const std::string &name)
    {
      const std::size_t place = file.column(name);
      if (place == file.names.size())
        throw ParameterError("missing column " + in_quotes(name), file.where_names,
                             "add it; the required columns are " + boost::algorithm::join(place_columns, ", "));
      Eigen::VectorXd result(static_cast<Eigen::Index>(file.rows.size()));
      for (std::size_t i = 0; i < file.rows.size(); ++i)
        result[static_cast<Eigen::Index>(i)] = file.number(i, place);
      return result;
    }
  } // namespace

  Sensors read_sensors(const std::string &path)
  {
    const CsvFile file = read_csv(path, parameter_of_sensors, "sensor");
    file.check_repeated_columns();
    const auto n = static_cast<Eigen::Index>(file.rows.size());
    Sensors    result{DenseMatrix(n, 3), DenseMatrix(n, 3), {}};
    for (int d = 0; d < 3; ++d)
      {
        result.positions.col(d)  = column(file, place_columns[d]);
        result.directions.col(d) = column(file, place_columns[3 + d]);
      }
    for (Eigen::Index i = 0; i < n; ++i)
      if (!(result.directions.row(i).norm() > 0.))
        throw ParameterError("the direction of the sensor is zero", file.where[i], "give a nonzero vector in the measuring direction");
    result.directions.rowwise().normalize();
    for (const std::string &name : file.names)
      {
        if (std::find(place_columns.begin(), place_columns.end(), name) != place_columns.end())
          continue;
        const bool        is_imaginary = boost::ends_with(name, imaginary);
        const std::string label        = is_imaginary ? name.substr(0, name.size() - std::string(imaginary).size()) : name;
        if (is_imaginary && file.column(label) == file.names.size())
          throw ParameterError("the imaginary part " + in_quotes(name) + " has no column with the real part", file.where_names,
                               "add the column " + in_quotes(label));
        const std::complex<double> unit = is_imaginary ? std::complex<double>(0., 1.) : 1.;
        Eigen::VectorXcd          &sum  = result.shapes.try_emplace(label, Eigen::VectorXcd::Zero(n)).first->second;
        sum += unit * column(file, name);
      }
    for (const auto &[label, shape] : result.shapes)
      if (!(shape.norm() > 0.))
        throw ParameterError("the shape " + in_quotes(label) + " is zero at all sensors", file.where_names,
                             "remove the columns of this shape");
    return result;
  }

  std::shared_ptr<const SparseMatrix> Sensors::rows(const ShapePoints &points) const
  {
    const MPI_Comm communicator = points.displacements->communicator();
    const bool     is_root      = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    const RowMap   own(is_root ? static_cast<int>(positions.rows()) : 0, communicator);
    return multiply(SparseMatrix(own, points.displacements->rows(),
                                 [&](const int i, SparseMatrix::Row &row) {
                                   Eigen::Index nearest = 0;
                                   (points.positions.rowwise() - positions.row(i)).rowwise().squaredNorm().minCoeff(&nearest);
                                   for (int d = 0; d < 3; ++d)
                                     if (directions(i, d) != 0.)
                                       row.emplace_back(static_cast<int>(3 * nearest) + d, directions(i, d));
                                 }),
                    *points.displacements);
  }

  double modal_assurance_criterion(const Eigen::VectorXcd &x, const Eigen::VectorXcd &y)
  {
    const double norms = x.squaredNorm() * y.squaredNorm();
    return norms > 0. ? std::norm(x.dot(y)) / norms : 0.;
  }
} // namespace Squeal
