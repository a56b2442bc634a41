// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/memory.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/matrix_market.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string.hpp>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <type_traits>

namespace Squeal
{
  namespace
  {
    /// Memory of a row or column without entries [byte].
    constexpr double bytes_of_row = 32.;

    /// Reads a text line by line and splits each line into words; error messages state the line number.
    class WordReader
    {
    public:
      explicit WordReader(const std::string &path)
        : path(path)
        , stream(path)
      {
        if (!stream)
          refuse(text("the file cannot be opened: ", std::strerror(errno)), "correct the name or the permissions of the file");
      }

      [[noreturn]] void refuse(const std::string &what,
                               const std::string &change =
                                 "write the matrix in Matrix Market form: coordinate or array, real or integer, with finite entries") const
      {
        throw FileError(what, text("file ", path, n_lines > 0 ? text(", line ", n_lines) : ""), change);
      }

      /// The words of the next line that is neither empty nor a comment; no words at the end of the file.
      const std::vector<std::string> &next(const bool with_comments = false)
      {
        words.clear();
        for (std::string line; words.empty() && std::getline(stream, line);)
          {
            ++n_lines;
            if (with_comments || line.front() != '%')
              boost::split(words, boost::trim_copy(line), boost::is_space(), boost::token_compress_on);
            if (words.size() == 1 && words.front().empty())
              words.clear();
          }
        return words;
      }

      template <typename Number>
      Number number(const std::string &word) const
      {
        Number            result{};
        const char *const end  = word.data() + word.size();
        const auto        read = std::from_chars(word.front() == '+' ? word.data() + 1 : word.data(), end, result);
        if (read.ec != std::errc() || read.ptr != end)
          refuse(in_quotes(word) + (std::is_integral_v<Number> ? " is not a valid integer" : " is not a valid number"));
        return result;
      }

    private:
      const std::string        path;
      std::ifstream            stream;
      std::vector<std::string> words;
      long                     n_lines = 0;
    };
  } // namespace

  SparseRows read_matrix_market(const std::string &path)
  {
    WordReader reader(path);
    auto       header = reader.next(true);
    for (std::string &word : header)
      boost::to_lower(word);
    const auto is = [&header](const std::size_t i, const char *name) { return header[i] == name; };
    if (header.size() != 5 || !is(0, "%%matrixmarket") || !is(1, "matrix") || !(is(2, "coordinate") || is(2, "array")))
      reader.refuse("the first line is not a Matrix Market header");
    if (!is(3, "real") && !is(3, "integer"))
      reader.refuse(text("the matrix is ", header[3], ", not real or integer"));
    const bool is_array = is(2, "array"), is_general = is(4, "general"), is_skew = is(4, "skew-symmetric");
    if (!is_general && !is_skew && !is(4, "symmetric"))
      reader.refuse(in_quotes(header[4]) + " is not general, symmetric or skew-symmetric");

    const std::vector<std::string> sizes = reader.next();
    if (sizes.size() != (is_array ? 2 : 3))
      reader.refuse("the line of sizes does not have " + std::string(is_array ? "two" : "three") + " numbers");
    const int n_rows = reader.number<int>(sizes[0]), n_columns = reader.number<int>(sizes[1]);
    if (n_rows < 1 || n_columns < 1 || (!is_general && n_rows != n_columns))
      reader.refuse(text("a matrix of size ", n_rows, " x ", n_columns, is_general ? " is empty" : " is empty or not square"));
    if (const double bytes = bytes_of_row * (double(n_rows) + n_columns); bytes > available_memory())
      reader.refuse(text("a matrix of size ", n_rows, " x ", n_columns, " requires more than ", bytes / 1e9, " GB of memory"),
                    "correct the sizes, or run on a machine with more memory");

    std::vector<Eigen::Triplet<double>> entries;
    const auto                          add = [&](const int row, const int column, const std::string &word) {
      const double value = reader.number<double>(word);
      if (!std::isfinite(value))
        reader.refuse(text("the entry in row ", row, " and column ", column, " is not finite"));
      if (row < 1 || row > n_rows || column < 1 || column > n_columns)
        reader.refuse(text("row ", row, " and column ", column, " are outside a matrix of size ", n_rows, " x ", n_columns));
      if (!is_general && (row < column || (is_skew && row == column)))
        reader.refuse(text("the entry in row ", row, " and column ", column, is_skew ? " is not below" : " is above", " the diagonal of a ",
                                                    header[4], " matrix"));
      if (value == 0.)
        return;
      entries.emplace_back(row - 1, column - 1, value);
      if (!is_general && row != column)
        entries.emplace_back(column - 1, row - 1, is_skew ? -value : value);
    };
    if (is_array)
      {
        std::vector<std::string> words;
        std::size_t              used = 0;
        for (int column = 1; column <= n_columns; ++column)
          for (int row = is_general ? 1 : is_skew ? column + 1 : column; row <= n_rows; ++row)
            {
              if (used == words.size())
                {
                  words = reader.next();
                  used  = 0;
                }
              if (words.empty())
                reader.refuse("there are fewer entries than the sizes require");
              add(row, column, words[used++]);
            }
        if (used < words.size() || !reader.next().empty())
          reader.refuse("there are more entries than the sizes allow");
      }
    else
      {
        const auto n = reader.number<long>(sizes[2]);
        if (n < 0)
          reader.refuse(text("the number of entries is negative: ", n));
        for (long k = 0; k < n; ++k)
          {
            const std::vector<std::string> &words = reader.next();
            if (words.empty())
              reader.refuse(text("the file contains only ", k, " of ", n, " entries"));
            if (words.size() != 3)
              reader.refuse("an entry does not consist of a row, a column and a value");
            add(reader.number<int>(words[0]), reader.number<int>(words[1]), words[2]);
          }
        if (!reader.next().empty())
          reader.refuse(text("the number of entries exceeds ", n));
      }
    SparseRows result(n_rows, n_columns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  std::string matrix_market(const SparseMatrix &A, const MatrixMarketSymmetry symmetry)
  {
    const bool         symmetric = symmetry == MatrixMarketSymmetry::symmetric;
    const SparseRows   rows      = local_rows(A);
    double             n         = 0.; // exact up to 2^53
    std::ostringstream lines;
    lines.precision(std::numeric_limits<double>::max_digits10);
    for (int i = 0; i < rows.rows(); ++i)
      for (SparseRows::InnerIterator entry(rows, i); entry; ++entry)
        if (const int number = A.rows().number(i); !symmetric || entry.col() <= number)
          {
            lines << number + 1 << ' ' << entry.col() + 1 << ' ' << entry.value() << '\n';
            n += 1.;
          }
    sum_over_processes(A.communicator(), &n, 1);
    const auto parts = dealii::Utilities::MPI::gather(A.communicator(), lines.str());
    if (A.rows().rank() != 0)
      return "";
    std::string result = text("%%MatrixMarket matrix coordinate real ", symmetric ? "symmetric" : "general", "\n", A.n_rows(), " ",
                              A.n_columns(), " ", static_cast<long long>(n), "\n");
    for (const std::string &part : parts)
      result += part;
    return result;
  }
} // namespace Squeal
