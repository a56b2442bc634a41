#include "chunked_rows.h"

#include <squeal/base/exceptions.h>
#include <squeal/output/hdf5_file.h>

#include <deal.II/base/mpi.h>

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <hdf5.h>

namespace Squeal
{
  namespace
  {
    /// Rows that are compressed together: a reader that wants a few need not expand all.
    constexpr std::uint64_t rows_of_chunk = 1 << 16;

    /// Room for what HDF5 notes of a dataset and of the place of a chunk, and for its buffers when a file is closed [byte].
    constexpr std::size_t room_for_notes = 1 << 18;

    [[noreturn]] void throw_not_written(const int problem, const std::string &shown)
    {
      throw FileError(std::string("the file cannot be written: ") + (problem != 0 ? std::strerror(problem) : "HDF5 failed"),
                      "file " + shown, "check permissions and free space, or set Output/Field format = VTU");
    }

    /// What HDF5 returned, which is negative where it fails. Its own calls of the system leave the cause in errno.
    template <typename Result>
    Result checked(const Result result, const std::string &shown)
    {
      if (result < 0)
        throw_not_written(errno, shown);
      return result;
    }

    /// A handle of HDF5 that is closed with its scope.
    class Handle
    {
    public:
      Handle(const hid_t id, herr_t (*close)(hid_t), const std::string &shown)
        : id(checked(id, shown))
        , close(close)
      {}

      Handle(const Handle &)            = delete;
      Handle &operator=(const Handle &) = delete;

      ~Handle()
      {
        close(id);
      }

      operator hid_t() const
      {
        return id;
      }

    private:
      const hid_t id;
      herr_t (*const close)(hid_t);
    };

    hid_t type_of(float)
    {
      return H5T_NATIVE_FLOAT;
    }

    hid_t type_of(std::int32_t)
    {
      return H5T_NATIVE_INT32;
    }
  } // namespace

  Hdf5File::Hdf5File(const std::filesystem::path &path, std::string shown_name, const MPI_Comm communicator)
    : shown(std::move(shown_name))
    , communicator(communicator)
    , is_writer(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , file(-1)
  {
    if (!is_writer)
      return;
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // problems are told by exceptions
    descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
      throw_not_written(errno, shown);
    keep_room(0); // before there is anything that HDF5 would have to write
    errno = 0;
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, shown), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, shown);
    checked(H5Pset_file_locking(access, false, true), shown); // which some file systems of clusters do not know
    checked(H5Pset_istore_k(creation, 1), shown);             // few chunks: their index takes no more room than it needs
    file = checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), shown);
    reserve(0);
  }

  Hdf5File::~Hdf5File()
  {
    if (file >= 0)
      H5Fclose(file);
    if (descriptor >= 0)
      ::close(descriptor);
  }

  void Hdf5File::reserve(const std::size_t bytes) const
  {
    hsize_t size;
    checked(H5Fget_filesize(file, &size), shown);
    keep_room(size + bytes);
  }

  void Hdf5File::keep_room(const std::size_t size) const
  {
    const int problem = ::posix_fallocate(descriptor, 0, static_cast<off_t>(size + room_for_notes));
    // Some file systems do not know how to.
    if (problem != 0 && problem != EOPNOTSUPP && problem != EINVAL)
      throw_not_written(problem, shown);
  }

  template <typename Number>
  void Hdf5File::add_values(const std::string &name, const std::vector<Number> &values, const unsigned int n_columns)
  {
    ChunkedRows rows(reinterpret_cast<const char *>(values.data()), values.size() / n_columns, n_columns * sizeof(Number), sizeof(Number),
                     rows_of_chunk, communicator);
    if (!is_writer)
      {
        rows.send();
        return;
      }
    reserve(0);
    errno                              = 0;
    const std::array<hsize_t, 2> shape = {{rows.n_rows(), n_columns}}, chunk = {{rows.rows_per_chunk(), n_columns}};
    const int                    rank = n_columns == 1 ? 1 : 2;
    const Handle                 space(H5Screate_simple(rank, shape.data(), nullptr), H5Sclose, shown);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, shown), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, shown);
    checked(H5Pset_create_intermediate_group(links, 1), shown);
    checked(H5Pset_obj_track_times(creation, false), shown); // equal results are equal files
    checked(H5Pset_chunk(creation, rank, chunk.data()), shown);
    checked(H5Pset_shuffle(creation), shown);
    checked(H5Pset_deflate(creation, ChunkedRows::compression_level), shown);
    const Handle dataset(H5Dcreate2(file, name.c_str(), type_of(Number()), space, links, creation, H5P_DEFAULT), H5Dclose, shown);
    rows.receive([&](const std::uint64_t first_row, const ChunkedRows::Chunk &bytes) {
      reserve(bytes.bytes.size());
      const std::array<hsize_t, 2> offset = {{first_row, 0}};
      errno                               = 0;
      // Bits of the mask: filters that were left out, in the order above
      checked(H5Dwrite_chunk(dataset, H5P_DEFAULT, bytes.is_deflated ? 0u : 2u, offset.data(), bytes.bytes.size(), bytes.bytes.data()),
              shown);
    });
  }

  void Hdf5File::add(const std::string &name, const std::vector<float> &values, const unsigned int n_columns)
  {
    add_values(name, values, n_columns);
  }

  void Hdf5File::add(const std::string &name, const std::vector<std::int32_t> &values, const unsigned int n_columns)
  {
    add_values(name, values, n_columns);
  }

  void Hdf5File::describe(const std::string &name, const std::string &text)
  {
    if (!is_writer)
      return;
    errno = 0;
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, shown), space(H5Screate(H5S_SCALAR), H5Sclose, shown);
    checked(H5Tset_size(type, H5T_VARIABLE), shown);
    checked(H5Tset_cset(type, H5T_CSET_UTF8), shown);
    const Handle      attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, shown);
    const char *const characters = text.c_str();
    checked(H5Awrite(attribute, type, &characters), shown);
  }

  void Hdf5File::close()
  {
    if (!is_writer)
      return;
    reserve(0);
    errno = 0;
    checked(H5Fflush(file, H5F_SCOPE_LOCAL), shown);
    hsize_t size;
    checked(H5Fget_filesize(file, &size), shown);
    checked(H5Fclose(file), shown);
    file = -1;
    // What has been kept beyond the end
    if (::ftruncate(descriptor, static_cast<off_t>(size)) != 0)
      throw_not_written(errno, shown);
  }
} // namespace Squeal
