#include <squeal/eigen/uncoupled_parts.h>

#include <Epetra_Comm.h>
#include <Epetra_Import.h>
#include <Epetra_IntVector.h>

#include <algorithm>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
    /// For each row here the smallest row number of its part: labels spread along the entries until none changes.
    Epetra_IntVector part_labels(const SparseMatrix &A)
    {
      Epetra_IntVector labels(A.RowMap()), neighbours(A.ColMap());
      std::copy_n(A.RowMap().MyGlobalElements(), A.NumMyRows(), labels.Values());
      const Epetra_Import import(A.ColMap(), A.RowMap());
      for (int changed = 1; changed != 0;)
        {
          neighbours.Import(labels, import, Insert);
          int changed_here = 0;
          for (int i = 0; i < A.NumMyRows(); ++i)
            {
              int     n;
              double *values;
              int    *columns;
              A.ExtractMyRowView(i, n, values, columns);
              for (int k = 0; k < n; ++k)
                if (neighbours[columns[k]] < labels[i])
                  {
                    labels[i]    = neighbours[columns[k]];
                    changed_here = 1;
                  }
            }
          A.Comm().MaxAll(&changed_here, &changed, 1);
        }
      return labels;
    }

    /// Values that occur on any process.
    std::set<int> union_of(const std::set<int> &here, const Epetra_Comm &comm)
    {
      int n = here.size(), n_largest = 0;
      comm.MaxAll(&n, &n_largest, 1);
      std::vector<int> mine(here.begin(), here.end()), all(static_cast<std::size_t>(n_largest) * comm.NumProc());
      mine.resize(n_largest, -1);
      comm.GatherAll(mine.data(), all.data(), n_largest);
      std::set<int> result(all.begin(), all.end());
      result.erase(-1);
      return result;
    }
  } // namespace

  std::vector<Epetra_Map> uncoupled_parts(const SparseMatrix &A)
  {
    const Epetra_IntVector          labels = part_labels(A);
    std::map<int, std::vector<int>> rows;
    std::set<int>                   here;
    for (int i = 0; i < labels.MyLength(); ++i)
      {
        rows[labels[i]].push_back(A.RowMap().GID(i));
        here.insert(labels[i]);
      }
    std::vector<Epetra_Map> parts;
    for (const int label : union_of(here, A.Comm()))
      {
        const std::vector<int> &mine = rows[label];
        parts.emplace_back(-1, static_cast<int>(mine.size()), mine.data(), 0, A.Comm());
      }
    return parts;
  }

  std::shared_ptr<SparseMatrix> part(const SparseMatrix &A, const Epetra_Map &rows)
  {
    auto             result = std::make_shared<SparseMatrix>(Copy, rows, A.MaxNumEntries());
    std::vector<int> numbers;
    for (int i = 0; i < rows.NumMyElements(); ++i)
      {
        int     n;
        double *values;
        int    *columns;
        A.ExtractMyRowView(A.LRID(rows.GID(i)), n, values, columns);
        numbers.clear();
        for (int k = 0; k < n; ++k)
          numbers.push_back(A.GCID(columns[k]));
        result->InsertGlobalValues(rows.GID(i), n, values, numbers.data());
      }
    result->FillComplete(rows, rows);
    return result;
  }

  void insert_part(const MultiVector &vectors, const int first, MultiVector &target)
  {
    for (int i = 0; i < vectors.MyLength(); ++i)
      {
        const int row = target.Map().LID(vectors.Map().GID(i));
        for (int j = 0; j < vectors.NumVectors(); ++j)
          target[first + j][row] = vectors[j][i];
      }
  }
} // namespace Squeal
