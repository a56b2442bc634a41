#include <squeal/eigen/uncoupled_parts.h>

#include <deal.II/base/mpi.h>

#include <boost/pending/disjoint_sets.hpp>

#include <map>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// For each row the smallest row number of its part, the same on every process.
    std::vector<int> part_labels(const SparseMatrix &A)
    {
      std::vector<int> label(A.n_rows());
      std::iota(label.begin(), label.end(), 0);
      SparseMatrix::Row row;
      while (true)
        {
          // Parts so far, joined by the rows here
          std::vector<int>                   rank(label.size(), 0), parent(label.size());
          boost::disjoint_sets<int *, int *> sets(rank.data(), parent.data());
          for (int i = 0; i < A.n_rows(); ++i)
            sets.make_set(i);
          for (int i = 0; i < A.n_rows(); ++i)
            sets.union_set(i, label[i]);
          for (int i = 0; i < A.rows().n_local(); ++i)
            {
              A.get_row(i, row);
              for (const auto &entry : row)
                sets.union_set(A.rows().number(i), entry.first);
            }
          std::vector<int> smallest(label.size(), A.n_rows()), joined(label.size());
          for (int i = A.n_rows(); i-- > 0;)
            smallest[sets.find_set(i)] = i;
          for (int i = 0; i < A.n_rows(); ++i)
            joined[i] = smallest[sets.find_set(i)];
          dealii::Utilities::MPI::min(joined, A.communicator(), joined);
          if (joined == label)
            return label;
          label = joined;
        }
    }
  } // namespace

  std::vector<RowMap> uncoupled_parts(const SparseMatrix &A)
  {
    const std::vector<int>          labels = part_labels(A);
    std::map<int, std::vector<int>> rows; // of each part on this process
    for (const int label : labels)
      rows[label];
    for (int i = 0; i < A.rows().n_local(); ++i)
      rows[labels[A.rows().number(i)]].push_back(A.rows().number(i));
    std::vector<RowMap> parts;
    for (const auto &[label, numbers] : rows)
      parts.push_back(RowMap::of(numbers, A.communicator()));
    return parts;
  }

  std::shared_ptr<SparseMatrix> part(const SparseMatrix &A, const RowMap &rows)
  {
    return std::make_shared<SparseMatrix>(rows, rows,
                                          [&](const int i, SparseMatrix::Row &row) { A.get_row(A.rows().place(rows.number(i)), row); });
  }

  void insert_part(const MultiVector &vectors, const int first, MultiVector &target)
  {
    for (int i = 0; i < vectors.n_local_rows(); ++i)
      target.local().row(target.map().place(vectors.map().number(i))).segment(first, vectors.n_columns()) = vectors.local().row(i);
  }
} // namespace Squeal
