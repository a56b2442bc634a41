#include "cholmod_triangle.h"
#include "elimination_order.h"
#include "libraries.h"
#include "sparse_products.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <string_view>

namespace Squeal
{
  namespace
  {
    /// Matrices with fewer rows are ordered faster than their better order would be found.
    constexpr int rows_for_dissection = 2000;

    /// Orders that are kept: of the coupled system, of the disc, and some more while parameters vary.
    constexpr std::size_t n_kept = 4;

    /// The lower triangle of a pattern by columns, which are the rows of the upper one.
    struct Pattern
    {
      explicit Pattern(const SparseRows &A)
        : start(1, 0)
      {
        row.reserve((A.start[A.n_rows] + A.n_rows) / 2);
        for (int i = 0; i < A.n_rows; ++i)
          {
            std::copy_if(A.column + A.start[i], A.column + A.start[i + 1], std::back_inserter(row), [&](const int j) { return j >= i; });
            start.push_back(static_cast<int>(row.size()));
          }
      }

      std::vector<int> start, row;
    };

    /// What tells one pattern from another. Two that were taken for one would share an order, which suits one of them less.
    struct Fingerprint
    {
      explicit Fingerprint(const Pattern &pattern)
        : n_rows(pattern.start.size() - 1)
        , of_starts(hash(pattern.start))
        , of_rows(hash(pattern.row))
      {}

      bool operator==(const Fingerprint &other) const
      {
        return n_rows == other.n_rows && of_starts == other.of_starts && of_rows == other.of_rows;
      }

      static std::size_t hash(const std::vector<int> &numbers)
      {
        return std::hash<std::string_view>()({reinterpret_cast<const char *>(numbers.data()), numbers.size() * sizeof(int)});
      }

      std::size_t n_rows, of_starts, of_rows;
    };

    /// The order of CHOLMOD, by the first of its methods or the better of both.
    std::vector<int> order_of(Pattern &pattern, const int n_methods, const std::string &what)
    {
      cholmod_common common;
      cholmod_start(&common);
      common.print              = 0;
      common.supernodal         = CHOLMOD_SIMPLICIAL; // no more than its permutation is wanted
      common.nmethods           = n_methods;
      common.method[0].ordering = CHOLMOD_AMD;
      common.method[1].ordering = CHOLMOD_METIS;

      cholmod_sparse   S = lower_triangle(pattern.start, pattern.row, nullptr);
      cholmod_factor  *L = cholmod_analyze(&S, &common);
      std::vector<int> result;
      if (L != nullptr)
        result.assign(static_cast<const int *>(L->Perm), static_cast<const int *>(L->Perm) + S.nrow);
      const int status = common.status;
      cholmod_free_factor(&L, &common);
      cholmod_finish(&common);
      if (result.size() != S.nrow)
        throw_library_failure("CHOLMOD", "status " + std::to_string(status) + " of the order of elimination", what);
      return result;
    }

    using Order = std::vector<int>;

    /// The last orders, newest first. Of threads that want the same one, the first makes it and the others wait, but not for other orders.
    class KnownOrders
    {
    public:
      /// The order of a pattern; @p make makes it unless it is there, or on its way.
      template <typename Make>
      Order find(const Fingerprint &pattern, const Make &make)
      {
        std::promise<Order>       promise;
        std::shared_future<Order> order;
        bool                      is_new = false;
        {
          const std::lock_guard<std::mutex> lock(mutex);
          const auto known = std::find_if(all.begin(), all.end(), [&](const Known &k) { return k.pattern == pattern; });
          is_new           = known == all.end();
          order            = is_new ? promise.get_future().share() : known->order;
          if (is_new)
            all.push_front({pattern, order});
          if (all.size() > n_kept)
            all.pop_back();
        }
        if (is_new)
          try
            {
              promise.set_value(make());
            }
          catch (...)
            {
              // Another attempt may find more memory
              promise.set_exception(std::current_exception());
              const std::lock_guard<std::mutex> lock(mutex);
              all.erase(std::remove_if(all.begin(), all.end(), [&](const Known &k) { return k.pattern == pattern; }), all.end());
            }
        return order.get();
      }

    private:
      struct Known
      {
        Fingerprint               pattern;
        std::shared_future<Order> order;
      };

      std::mutex        mutex;
      std::deque<Known> all;
    };
  } // namespace

  std::vector<int> elimination_order(const SparseMatrix &A, const std::string &what)
  {
    Pattern pattern(A.entries()->rows());
    if (A.n_rows() < rows_for_dissection)
      return order_of(pattern, 1, what);

    static KnownOrders known;
    return known.find(Fingerprint(pattern), [&] {
      const std::lock_guard<std::mutex> lock(ordering());
      return order_of(pattern, 2, what);
    });
  }
} // namespace Squeal
