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

  std::vector<UncoupledPart> uncoupled_parts(const SparseMatrix &A)
  {
    const std::vector<int>       labels  = part_labels(A);
    const auto                   numbers = std::make_shared<std::vector<int>>();
    std::map<int, UncoupledPart> parts;
    std::map<int, int>           sizes;
    // Rows keep their order, in which processes have them one after the other
    for (const int label : labels)
      {
        parts[label];
        numbers->push_back(sizes[label]++);
      }
    for (int i = 0; i < A.rows().n_local(); ++i)
      parts[labels[A.rows().number(i)]].places.push_back(i);
    std::vector<UncoupledPart> result;
    for (auto &[label, part] : parts)
      result.push_back({RowMap(static_cast<int>(part.places.size()), A.communicator()), std::move(part.places), numbers});
    return result;
  }

  std::shared_ptr<SparseMatrix> matrix_of(const UncoupledPart &part, const SparseMatrix &A)
  {
    return std::make_shared<SparseMatrix>(part.map, part.map, [&](const int i, SparseMatrix::Row &row) {
      A.get_row(part.places[i], row);
      for (auto &entry : row)
        entry.first = (*part.numbers)[entry.first];
    });
  }
} // namespace Squeal
