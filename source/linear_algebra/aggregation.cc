#include "aggregation.h"

#include "ghost_exchange.h"

#include <squeal/base/exceptions.h>

#include <MueLu_CreateXpetraPreconditioner.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Xpetra_CrsMatrixWrap.hpp>
#include <Xpetra_MultiVectorFactory.hpp>
#include <Xpetra_TpetraCrsMatrix.hpp>
#include <Xpetra_TpetraMultiVector.hpp>

#include <map>
#include <unordered_map>

namespace Squeal
{
  namespace
  {
    using Local        = int;
    using Global       = long long;
    using Processor    = Tpetra::Map<>::node_type;
    using Map          = Tpetra::Map<Local, Global, Processor>;
    using CrsMatrix    = Tpetra::CrsMatrix<double, Local, Global, Processor>;
    using Vectors      = Tpetra::MultiVector<double, Local, Global, Processor>;
    using Matrix       = Xpetra::Matrix<double, Local, Global, Processor>;
    using XpetraMatrix = Xpetra::TpetraCrsMatrix<double, Local, Global, Processor>;
    using Teuchos::RCP;
    using Teuchos::rcp;

    /**
     * Every point has as many rows, as MueLu wants it: where contact or a clamp has taken some away, rows of the identity matrix,
     * without any part in the near null space, take their places.
     */
    struct FullPoints
    {
      explicit FullPoints(const SparseMatrix &A, const NearNullSpace &space)
      {
        std::unordered_map<int, int> index;
        std::vector<int>             n_rows, slot;
        for (const int point : space.points)
          {
            const auto [found, is_new] = index.try_emplace(point, static_cast<int>(n_rows.size()));
            if (is_new)
              n_rows.push_back(0);
            place.push_back(found->second);
            slot.push_back(n_rows[found->second]++);
          }
        const int largest = n_rows.empty() ? 1 : *std::max_element(n_rows.begin(), n_rows.end());
        n_slots           = dealii::Utilities::MPI::max(largest, A.communicator());
        for (std::size_t i = 0; i < place.size(); ++i)
          place[i] = place[i] * n_slots + slot[i];
        const auto communicator = rcp(new Teuchos::MpiComm<int>(A.communicator()));
        map = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), n_rows.size() * n_slots, 0, communicator));
      }

      int              n_slots;
      std::vector<int> place; ///< of each own row
      RCP<const Map>   map;
    };

    /// A on full points.
    RCP<CrsMatrix> expanded(const SparseMatrix &A, const FullPoints &points)
    {
      // Columns of other processes
      std::map<int, int> ghosts;
      SparseMatrix::Row  row;
      for (int i = 0; i < A.rows().n_local(); ++i)
        {
          A.get_row(i, row);
          for (const auto &entry : row)
            if (A.columns().place(entry.first) < 0)
              ghosts.emplace(entry.first, 0);
        }
      std::vector<int> numbers;
      for (auto &[number, position] : ghosts)
        {
          position = static_cast<int>(numbers.size());
          numbers.push_back(number);
        }
      std::vector<Global> own(A.rows().n_local()), others(numbers.size());
      for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = points.map->getGlobalElement(points.place[i]);
      GhostExchange(A.columns(), numbers)(own.data(), others.data());

      const std::size_t           n = points.map->getNodeNumElements();
      Teuchos::Array<std::size_t> n_entries(n, 1);
      for (int i = 0; i < A.rows().n_local(); ++i)
        {
          A.get_row(i, row);
          n_entries[points.place[i]] = row.size();
        }
      std::vector<bool>   is_row(n, false);
      const auto          result = rcp(new CrsMatrix(points.map, n_entries(), Tpetra::StaticProfile));
      std::vector<Global> columns;
      std::vector<double> values;
      for (int i = 0; i < A.rows().n_local(); ++i)
        {
          A.get_row(i, row);
          columns.clear();
          values.clear();
          for (const auto &[number, value] : row)
            {
              const int place = A.columns().place(number);
              columns.push_back(place >= 0 ? own[place] : others[ghosts.at(number)]);
              values.push_back(value);
            }
          result->insertGlobalValues(own[i], static_cast<Local>(columns.size()), values.data(), columns.data());
          is_row[points.place[i]] = true;
        }
      const double one = 1.;
      for (std::size_t i = 0; i < n; ++i)
        if (const Global number = points.map->getGlobalElement(static_cast<Local>(i)); !is_row[i])
          result->insertGlobalValues(number, 1, &one, &number);
      result->fillComplete();
      return result;
    }

    RCP<Vectors> expanded(const MultiVector &X, const FullPoints &points)
    {
      const auto result = rcp(new Vectors(points.map, X.n_columns()));
      for (int j = 0; j < X.n_columns(); ++j)
        {
          const auto column = result->getDataNonConst(j);
          for (std::size_t i = 0; i < points.place.size(); ++i)
            column[points.place[i]] = X(static_cast<int>(i), j);
        }
      return result;
    }

    /// A matrix of MueLu's with rows and columns of this program; @p places: of the rows, empty: all in their order.
    std::shared_ptr<SparseMatrix> converted(const Matrix &A, const RowMap &rows, const RowMap &columns, const std::vector<int> &places)
    {
      const auto &column_map = *A.getColMap();
      return std::make_shared<SparseMatrix>(rows, columns, [&](const int i, SparseMatrix::Row &row) {
        Teuchos::ArrayView<const Local>  numbers;
        Teuchos::ArrayView<const double> values;
        A.getLocalRowView(places.empty() ? i : places[i], numbers, values);
        for (Local k = 0; k < numbers.size(); ++k)
          row.emplace_back(static_cast<int>(column_map.getGlobalElement(numbers[k])), values[k]);
      });
    }

    Teuchos::ParameterList parameters_of_muelu(const int n_slots)
    {
      Teuchos::ParameterList parameters;
      parameters.set("verbosity", "none");
      parameters.set("number of equations", n_slots);
      parameters.set("multigrid algorithm", "sa");
      parameters.set("aggregation: type", "uncoupled");
      parameters.set("max levels", 10);
      parameters.set("coarse: max size", largest_coarse_matrix);
      // Levels are smoothed and solved here, with many vectors at a time.
      parameters.set("smoother: pre or post", "none");
      parameters.set("coarse: type", "RELAXATION");
      parameters.set("transpose: use implicit", true);
      return parameters;
    }
  } // namespace

  std::vector<Level> aggregate(const SparseMatrix &A, const NearNullSpace &space, const std::string &what)
  {
    const FullPoints       points(A, space);
    const RCP<CrsMatrix>   matrix     = expanded(A, points);
    const RCP<Matrix>      wrapped    = rcp(new Xpetra::CrsMatrixWrap<double, Local, Global, Processor>(
      RCP<Xpetra::CrsMatrix<double, Local, Global, Processor>>(rcp(new XpetraMatrix(matrix)))));
    Teuchos::ParameterList parameters = parameters_of_muelu(points.n_slots);
    const RCP<Xpetra::MultiVector<double, Local, Global, Processor>> null_space =
      rcp(new Xpetra::TpetraMultiVector<double, Local, Global, Processor>(expanded(space.vectors, points)));
    parameters.sublist("user data").set("Nullspace", null_space);
    try
      {
        const auto         hierarchy = MueLu::CreateXpetraPreconditioner<double, Local, Global, Processor>(wrapped, parameters);
        std::vector<Level> levels(hierarchy->GetNumLevels());
        RowMap             fine = A.rows();
        for (int l = 0; l + 1 < static_cast<int>(levels.size()); ++l)
          {
            MueLu::Level &next     = *hierarchy->GetLevel(l + 1);
            const auto    P        = next.Get<RCP<Matrix>>("P");
            const RowMap  coarse   = RowMap::contiguous(static_cast<int>(P->getDomainMap()->getNodeNumElements()), A.communicator());
            levels[l].prolongation = converted(*P, fine, coarse, l == 0 ? points.place : std::vector<int>());
            levels[l + 1].matrix   = converted(*next.Get<RCP<Matrix>>("A"), coarse, coarse, {});
            fine                   = coarse;
          }
        return levels;
      }
    catch (const std::exception &error)
      {
        throw SolverError(std::string("MueLu failed: ") + error.what(), what, "choose a factorisation instead of multigrid");
      }
  }
} // namespace Squeal
