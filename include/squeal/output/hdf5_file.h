#pragma once

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * A file in the format HDF5 that processes write together, each its rows of every dataset. All must call.
   *
   * Chunks of rows are compressed by the process that has their first row, and process 0 writes them one after the other: none has more of
   * a dataset than its part and a chunk. Bytes of equal weight are put side by side and compressed (the filters `shuffle` and `deflate` of
   * HDF5, which every reader has). Throws FileError with the cause, on process 0, if the file cannot be written.
   */
  class Hdf5File
  {
  public:
    /**
     * @param path  of the file; does not matter on other processes than 0
     * @param shown its name for messages
     */
    Hdf5File(const std::filesystem::path &path, std::string shown, MPI_Comm communicator);
    ~Hdf5File();
    Hdf5File(const Hdf5File &)            = delete;
    Hdf5File &operator=(const Hdf5File &) = delete;

    /**
     * A dataset of values row by row, below `/` or a group that is made with it: "bodies/points". One column: a vector.
     *
     * @param values rows of this process; those of process 0 come first in the file
     */
    void add(const std::string &name, const std::vector<float> &values, unsigned int n_columns = 1);
    void add(const std::string &name, const std::vector<std::int32_t> &values, unsigned int n_columns = 1);

    /// A text as attribute of the whole file.
    void describe(const std::string &name, const std::string &text);

    /// Completes the file.
    void close();

  private:
    /// Makes the disk keep room for the next bytes: HDF5 cannot close a file once a write has failed.
    void reserve(std::size_t bytes) const;
    void keep_room(std::size_t size) const;

    template <typename Number>
    void add_values(const std::string &name, const std::vector<Number> &values, unsigned int n_columns);

    const std::string shown;
    const MPI_Comm    communicator;
    bool              is_writer;
    std::int64_t      file;            ///< HDF5's handle on process 0; negative: none
    int               descriptor = -1; ///< of the same file
  };
} // namespace Squeal
