#include <squeal/geometry/gmsh_mesh.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace Squeal
{
  namespace
  {
    class Writer
    {
    public:
      template <typename T>
      void add(const T &value)
      {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes.append(reinterpret_cast<const char *>(&value), sizeof(T));
      }

      /// A vector or string of plain values.
      template <typename Values>
      void add_all(const Values &values)
      {
        add(values.size());
        bytes.append(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(values[0]));
      }

      std::string bytes;
    };

    class Reader
    {
    public:
      explicit Reader(const std::string &bytes)
        : bytes(bytes)
      {}

      template <typename T>
      T get()
      {
        T value;
        std::memcpy(&value, take(sizeof(T)), sizeof(T));
        return value;
      }

      template <typename Values>
      Values get_all()
      {
        using Value            = typename Values::value_type;
        const std::size_t size = get<std::size_t>();
        if (size > (bytes.size() - position) / sizeof(Value))
          throw std::length_error("the mesh is incomplete");
        Values values(size, Value());
        if (size > 0)
          std::memcpy(values.data(), take(size * sizeof(Value)), size * sizeof(Value));
        return values;
      }

    private:
      const char *take(const std::size_t size)
      {
        if (size > bytes.size() - position)
          throw std::length_error("the mesh is incomplete");
        position += size;
        return bytes.data() + position - size;
      }

      const std::string &bytes;
      std::size_t        position = 0;
    };
  } // namespace

  int GmshMesh::dimension() const
  {
    int result = 0;
    for (const Group &group : groups)
      result = std::max(result, group.dimension);
    return result;
  }

  std::string to_bytes(const GmshMesh &mesh)
  {
    Writer writer;
    writer.add_all(mesh.points);
    writer.add(mesh.n_unnamed_volume_elements);
    writer.add(mesh.groups.size());
    for (const GmshMesh::Group &group : mesh.groups)
      {
        writer.add(group.dimension);
        writer.add_all(group.name);
        writer.add(group.blocks.size());
        for (const GmshMesh::Block &block : group.blocks)
          {
            writer.add_all(block.type);
            writer.add(block.nodes_per_element);
            writer.add_all(block.tags);
            writer.add_all(block.nodes);
          }
      }
    return writer.bytes;
  }

  GmshMesh from_bytes(const std::string &bytes)
  {
    Reader   reader(bytes);
    GmshMesh mesh;
    mesh.points                    = reader.get_all<decltype(mesh.points)>();
    mesh.n_unnamed_volume_elements = reader.get<std::size_t>();
    for (std::size_t n_groups = reader.get<std::size_t>(); n_groups > 0; --n_groups)
      {
        GmshMesh::Group group;
        group.dimension = reader.get<int>();
        group.name      = reader.get_all<std::string>();
        for (std::size_t n_blocks = reader.get<std::size_t>(); n_blocks > 0; --n_blocks)
          {
            GmshMesh::Block block;
            block.type              = reader.get_all<std::string>();
            block.nodes_per_element = reader.get<unsigned int>();
            block.tags              = reader.get_all<decltype(block.tags)>();
            block.nodes             = reader.get_all<decltype(block.nodes)>();
            group.blocks.push_back(std::move(block));
          }
        mesh.groups.push_back(std::move(group));
      }
    return mesh;
  }
} // namespace Squeal
