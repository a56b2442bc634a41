#include "supernodal_solve.h"
#include "supernode_kernels.h"

#include <squeal/base/tasks.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    constexpr int    n_parts           = 8;
    constexpr double least_parted      = 2e5;                ///< entries of a factor that are worth several tasks
    constexpr double largest_of_parted = 1. / (2 * n_parts); ///< subtree that is not divided further / all

    constexpr int widest = 16;

    template <int width>
    LaneRow<width> *rows_of(dealii::AlignedVector<double> &numbers)
    {
      return reinterpret_cast<LaneRow<width> *>(numbers.data());
    }

    /// A supernode with its rows.
    struct RowsOfSupernode
    {
      RowsOfSupernode(const SupernodalFactor &L, const int s)
        : block{L.n_columns(s), L.n_rows_of(s), L.value + L.value_start[s]}
        , row(L.row + L.row_start[s])
      {}

      const Supernode block;
      const int      *row;
    };

    /// Rows of subtrees are changed where they are; what is added to those of the top, from the first one of them on, goes to @p changes.
    template <int width>
    void eliminate(const RowsOfSupernode  &s,
                   const std::vector<int> &place_in_top,
                   LaneRow<width>         *rows,
                   LaneRow<width>         *changes,
                   LaneRow<width>         *front)
    {
      LaneRow<width> *own = rows + s.row[0];
      std::copy(own, own + s.block.n_columns, front);
      std::fill(front + s.block.n_columns, front + s.block.n_rows, LaneRow<width>{});
      solve_forward(s.block, front);
      std::copy(front, front + s.block.n_columns, own);
      int i = s.block.n_columns;
      for (; i < s.block.n_rows && (changes == nullptr || place_in_top[s.row[i]] < 0); ++i)
        add_row(rows[s.row[i]], front[i]);
      for (; i < s.block.n_rows; ++i)
        add_row(changes[place_in_top[s.row[i]]], front[i]);
    }

    template <int width>
    void substitute(const RowsOfSupernode &s, LaneRow<width> *rows, LaneRow<width> *front)
    {
      LaneRow<width> *own = rows + s.row[0];
      std::copy(own, own + s.block.n_columns, front);
      for (int i = s.block.n_columns; i < s.block.n_rows; ++i)
        front[i] = rows[s.row[i]];
      solve_backward(s.block, front);
      std::copy(front, front + s.block.n_columns, own);
    }
  } // namespace

  SupernodalSolve::SupernodalSolve(const SupernodalFactor &L)
    : L(L)
    , place_in_top(L.n_rows, -1)
  {
    // ------------------------------------------------- entries of the subtree below and with each supernode
    const int           n = L.n_supernodes;
    std::vector<int>    supernode_of(L.n_rows), parent(n, -1);
    std::vector<double> entries(n, 0.);
    double              all = 0.;
    for (int s = 0; s < n; ++s)
      std::fill(supernode_of.begin() + L.first_column[s], supernode_of.begin() + L.first_column[s + 1], s);
    for (int s = 0; s < n; ++s)
      {
        const int n_columns = L.n_columns(s), n_rows = L.n_rows_of(s);
        largest_n_rows = std::max(largest_n_rows, n_rows);
        entries[s] += static_cast<double>(n_columns) * n_rows;
        if (n_rows > n_columns)
          {
            parent[s] = supernode_of[L.row[L.row_start[s] + n_columns]];
            entries[parent[s]] += entries[s];
          }
        else
          all += entries[s];
      }

    // ------------------------------------------------- what is too large for a task of its own is the top
    const bool   is_parted = all >= least_parted;
    const double largest   = is_parted ? all * largest_of_parted : all;
    for (int s = 0; s < n; ++s)
      if (entries[s] > largest)
        {
          top.push_back(s);
          for (int column = L.first_column[s]; column < L.first_column[s + 1]; ++column)
            {
              place_in_top[column] = top_rows.size();
              top_rows.push_back(column);
            }
        }

    // ------------------------------------------------- the largest subtree next, to the part that has least
    std::vector<int> roots;
    for (int s = 0; s < n; ++s)
      if (entries[s] <= largest && (parent[s] < 0 || entries[parent[s]] > largest))
        roots.push_back(s);
    std::stable_sort(roots.begin(), roots.end(), [&](const int a, const int b) { return entries[a] > entries[b]; });
    parts.resize(is_parted ? n_parts : 1);
    std::vector<double> work(parts.size(), 0.);
    std::vector<int>    part_of(n, -1);
    for (const int root : roots)
      {
        part_of[root] = std::min_element(work.begin(), work.end()) - work.begin();
        work[part_of[root]] += entries[root];
      }
    for (int s = n - 1; s >= 0; --s)
      if (entries[s] <= largest && part_of[s] < 0)
        part_of[s] = part_of[parent[s]];
    for (int s = 0; s < n; ++s)
      if (part_of[s] >= 0)
        parts[part_of[s]].push_back(s);
  }

  std::unique_ptr<SupernodalSolve::Workspace> SupernodalSolve::borrow(const int width) const
  {
    std::unique_ptr<Workspace> result;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!workspaces.empty())
        {
          result = std::move(workspaces.back());
          workspaces.pop_back();
        }
    }
    if (!result)
      result = std::make_unique<Workspace>();
    const auto fit = [width](dealii::AlignedVector<double> &numbers, const int n_rows) {
      if (const std::size_t size = static_cast<std::size_t>(n_rows) * width; numbers.size() < size)
        numbers.resize_fast(size);
    };
    fit(result->rows, L.n_rows);
    result->changes.resize(parts.size());
    result->fronts.resize(parts.size());
    for (std::size_t part = 0; part < parts.size(); ++part)
      {
        fit(result->changes[part], top_rows.size());
        fit(result->fronts[part], largest_n_rows);
      }
    return result;
  }

  void SupernodalSolve::give_back(std::unique_ptr<Workspace> workspace) const
  {
    const std::lock_guard<std::mutex> lock(mutex);
    workspaces.push_back(std::move(workspace));
  }

  template <int width>
  void SupernodalSolve::solve_group(const MultiVector &X, MultiVector &Y, const int first, const Tasks &in_tasks) const
  {
    std::unique_ptr<Workspace> workspace = borrow(width);
    LaneRow<width>            *rows = rows_of<width>(workspace->rows), *front = rows_of<width>(workspace->fronts.front());
    const int                  n_tasks = static_cast<int>(parts.size()), n_columns = std::min(width, X.n_columns() - first);
    to_lanes(X.col(first).data(), X.n_local_rows(), L.n_rows, n_columns, rows, L.permutation);

    in_tasks(n_tasks, [&](const int part) {
      LaneRow<width> *changes = rows_of<width>(workspace->changes[part]), *front_of_part = rows_of<width>(workspace->fronts[part]);
      std::fill(changes, changes + top_rows.size(), LaneRow<width>{});
      for (const int s : parts[part])
        eliminate(RowsOfSupernode(L, s), place_in_top, rows, changes, front_of_part);
    });
    for (int part = 0; part < n_tasks; ++part)
      for (std::size_t i = 0; i < top_rows.size(); ++i)
        add_row(rows[top_rows[i]], rows_of<width>(workspace->changes[part])[i]);
    for (const int s : top)
      eliminate<width>(RowsOfSupernode(L, s), place_in_top, rows, nullptr, front);

    std::for_each(top.rbegin(), top.rend(), [&](const int s) { substitute(RowsOfSupernode(L, s), rows, front); });
    in_tasks(n_tasks, [&](const int part) {
      std::for_each(parts[part].rbegin(), parts[part].rend(),
                    [&](const int s) { substitute(RowsOfSupernode(L, s), rows, rows_of<width>(workspace->fronts[part])); });
    });

    from_lanes(rows, Y.col(first).data(), Y.n_local_rows(), L.n_rows, n_columns, L.permutation);
    give_back(std::move(workspace));
  }

  void SupernodalSolve::apply(const MultiVector &X, MultiVector &Y) const
  {
    if (L.n_rows == 0)
      return;
    const int   n = X.n_columns(), n_groups = (n + widest - 1) / widest;
    const Tasks one_by_one = [](const int n_tasks, const std::function<void(int)> &task) {
      for (int i = 0; i < n_tasks; ++i)
        task(i);
    };
    // Either groups of columns or subtrees are tasks: the arithmetic is the same
    const Tasks in_tasks = n_groups > 1 ? one_by_one : Tasks(run_tasks);
    run_tasks(n_groups, [&](const int group) {
      const int first = group * widest, n_columns = std::min(widest, n - first);
      if (n_columns > 8)
        solve_group<16>(X, Y, first, in_tasks);
      else if (n_columns > 4)
        solve_group<8>(X, Y, first, in_tasks);
      else
        solve_group<4>(X, Y, first, in_tasks);
    });
  }
} // namespace Squeal
