#include <squeal/base/exceptions.h>
#include <squeal/output/hdf5_image.h>

#include <algorithm>
#include <array>
#include <hdf5.h>

namespace Squeal
{
  namespace
  {
    /// Rows that are compressed together: a reader that wants a few need not expand all.
    constexpr hsize_t rows_of_chunk = 1 << 16;

    /// Of 1 to 9; with higher ones shapes of modes get smaller by half a per cent at most, and take up to two and a half times as long.
    constexpr unsigned int compression_level = 1;

    /// By how much the image grows at a time [byte].
    constexpr std::size_t increment = 1 << 20;

    /// What HDF5 returned, which is negative where it fails.
    template <typename Result>
    Result checked(const Result result)
    {
      if (result < 0)
        throw FileError("a file of fields could not be made in memory", "HDF5",
                        "use a machine with more memory, or Output/Field format = VTU");
      return result;
    }

    /// A handle of HDF5 that is closed with its scope.
    class Handle
    {
    public:
      Handle(const hid_t id, herr_t (*close)(hid_t))
        : id(checked(id))
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

    hid_t file_in_memory()
    {
      H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // problems are told by exceptions
      const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      checked(H5Pset_fapl_core(access, increment, false));
      const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
      checked(H5Pset_istore_k(creation, 1)); // few chunks: their index takes no more room than it needs
      return checked(H5Fcreate("image", H5F_ACC_TRUNC, creation, access));
    }
  } // namespace

  Hdf5Image::Hdf5Image()
    : file(file_in_memory())
  {}

  Hdf5Image::~Hdf5Image()
  {
    H5Fclose(file);
  }

  template <typename Number>
  void Hdf5Image::add_values(const std::string &name, const std::vector<Number> &values, const unsigned int n_columns)
  {
    const std::array<hsize_t, 2> shape = {{values.size() / n_columns, n_columns}};
    const std::array<hsize_t, 2> chunk = {{std::clamp<hsize_t>(shape[0], 1, rows_of_chunk), n_columns}};
    const int                    rank  = n_columns == 1 ? 1 : 2;
    const Handle                 space(H5Screate_simple(rank, shape.data(), nullptr), H5Sclose);
    const Handle                 creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    checked(H5Pset_create_intermediate_group(links, 1));
    checked(H5Pset_obj_track_times(creation, false)); // equal results are equal files
    checked(H5Pset_chunk(creation, rank, chunk.data()));
    checked(H5Pset_shuffle(creation));
    checked(H5Pset_deflate(creation, compression_level));
    const Handle dataset(H5Dcreate2(file, name.c_str(), type_of(Number()), space, links, creation, H5P_DEFAULT), H5Dclose);
    checked(H5Dwrite(dataset, type_of(Number()), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  }

  void Hdf5Image::add(const std::string &name, const std::vector<float> &values, const unsigned int n_columns)
  {
    add_values(name, values, n_columns);
  }

  void Hdf5Image::add(const std::string &name, const std::vector<std::int32_t> &values, const unsigned int n_columns)
  {
    add_values(name, values, n_columns);
  }

  void Hdf5Image::describe(const std::string &name, const std::string &text)
  {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    checked(H5Tset_size(type, H5T_VARIABLE));
    checked(H5Tset_cset(type, H5T_CSET_UTF8));
    const Handle      attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const char *const characters = text.c_str();
    checked(H5Awrite(attribute, type, &characters));
  }

  std::string Hdf5Image::bytes() const
  {
    checked(H5Fflush(file, H5F_SCOPE_LOCAL));
    std::string result(checked(H5Fget_file_image(file, nullptr, 0)), '\0');
    checked(H5Fget_file_image(file, result.data(), result.size()));
    return result;
  }
} // namespace Squeal
