#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * A file in the format HDF5, made in memory, so that it gets to the disk in the way of all results (ResultFolder::write()).
   *
   * Bytes of equal weight are put side by side and compressed (the filters `shuffle` and `deflate` of HDF5, which every reader has).
   * Throws FileError where HDF5 fails, which without a file on disk is for lack of memory.
   */
  class Hdf5Image
  {
  public:
    Hdf5Image();
    ~Hdf5Image();
    Hdf5Image(const Hdf5Image &)            = delete;
    Hdf5Image &operator=(const Hdf5Image &) = delete;

    /// A dataset of values row by row, below `/` or a group that is made with it: "bodies/points". One column: a vector.
    void add(const std::string &name, const std::vector<float> &values, unsigned int n_columns = 1);
    void add(const std::string &name, const std::vector<std::int32_t> &values, unsigned int n_columns = 1);

    /// A text as attribute of the whole file.
    void describe(const std::string &name, const std::string &text);

    /// What the file would hold.
    std::string bytes() const;

  private:
    template <typename Number>
    void add_values(const std::string &name, const std::vector<Number> &values, unsigned int n_columns);

    std::int64_t file; ///< HDF5's handle
  };
} // namespace Squeal
