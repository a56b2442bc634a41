#include <squeal/base/text.h>
#include <squeal/output/hdf5_file.h>
#include <squeal/output/xdmf_writer.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;
    using Grid    = XdmfWriter::Grid;
    using Tree    = boost::property_tree::ptree;

    /// Names in files of meshes.
    constexpr const char *body_group = "bodies", *contact_group = "contact", *closed_dataset = "contact/closed";

    constexpr const char *contact_ending = "_contact.xdmf";

    std::string mesh_file(const std::optional<Component> &component)
    {
      return component ? text("modes/mesh_", *component == Component::disc ? "disc" : "pins", ".h5") : "modes/mesh.h5";
    }

    // ---------------------------------------------------------------------------------------------------- values in HDF5

    /// A file of HDF5 in the result folder whose fields are noted where they belong.
    class FieldFile
    {
    public:
      FieldFile(const ResultFolder &folder, std::string given_name, const MPI_Comm communicator)
        : folder(folder)
        , name(std::move(given_name))
        , file(folder.begin_file(name), folder.name() + "/" + name, communicator)
      {}

      void add(const std::string &group, const FieldMesh &mesh)
      {
        std::vector<float> points;
        for (const Node &node : mesh.nodes)
          points.insert(points.end(), node.position.begin(), node.position.end());
        file.add(group + "/points", points, 3);
        file.add(group + "/cells", mesh.cells, mesh.corners);
        file.add(group + "/component", mesh.components);
      }

      /// @param values one for each vertex that this process writes
      void add(const std::string &dataset, const std::vector<float> &values)
      {
        file.add(dataset, values);
      }

      /// @param values one or three for each vertex that this process writes
      void add(Grid                     &grid,
               const std::string        &field,
               const std::string        &dataset,
               const std::vector<float> &values,
               const unsigned int        n_columns)
      {
        file.add(dataset, values, n_columns);
        grid.fields.push_back({field, name, dataset, n_columns});
      }

      void describe(const std::string &title, const std::string &mesh)
      {
        file.describe("mode", title);
        file.describe("mesh", std::filesystem::path(mesh).lexically_relative(std::filesystem::path(name).parent_path()));
      }

      void finish()
      {
        file.close();
        folder.end_file(name);
      }

    private:
      const ResultFolder &folder;
      const std::string   name;
      Hdf5File            file;
    };

    /// √Σ|u|² over the three displacements of each vertex, times a factor.
    template <typename Number>
    std::vector<float> amplitudes(const FieldMesh &mesh, const RowMap &map, const std::vector<Number> &displacement, const double scale)
    {
      DenseMatrix result(mesh.own.size(), 1);
      for (std::size_t i = 0; i < mesh.own.size(); ++i)
        {
          double sum = 0.;
          for (const int dof : mesh.own[i].dofs)
            if (const int row = map.place(dof); row >= 0)
              sum += std::norm(displacement[row]);
          result(i, 0) = scale * std::sqrt(sum);
        }
      return mesh.delivered(result);
    }

    /// value(u) of the three displacements of each vertex, u = 0 where it is clamped.
    template <typename Number, typename Function>
    std::vector<float> vertex_values(const FieldMesh           &mesh,
                                     const RowMap              &map,
                                     const std::vector<Number> &displacement,
                                     const Function            &value)
    {
      DenseMatrix result(mesh.own.size(), 3);
      for (std::size_t i = 0; i < mesh.own.size(); ++i)
        for (int d = 0; d < 3; ++d)
          {
            const int row = map.place(mesh.own[i].dofs[d]);
            result(i, d)  = row >= 0 ? value(displacement[row]) : 0.;
          }
      return mesh.delivered(result);
    }

    /// Values of all contact pairs, which process 0 writes.
    std::vector<float> on_root(const Model &model, std::vector<float> values)
    {
      return model.free_map().rank() == 0 ? std::move(values) : std::vector<float>();
    }

    // ---------------------------------------------------------------------------------------------------- XDMF

    Tree data_item(const std::string &reference, const std::size_t n_rows, const unsigned int n_columns, const bool is_integer)
    {
      Tree item;
      item.put("<xmlattr>.Dimensions", n_columns == 1 ? std::to_string(n_rows) : text(n_rows, " ", n_columns));
      item.put("<xmlattr>.NumberType", is_integer ? "Int" : "Float");
      item.put("<xmlattr>.Precision", 4);
      item.put("<xmlattr>.Format", "HDF");
      item.put_value(reference);
      return item;
    }

    Tree attribute(const std::string &name, const char *centre, const unsigned int n_columns, const Tree &item)
    {
      Tree result;
      result.put("<xmlattr>.Name", name);
      result.put("<xmlattr>.AttributeType", n_columns == 3 ? "Vector" : "Scalar");
      result.put("<xmlattr>.Center", centre);
      result.add_child("DataItem", item);
      return result;
    }

    /// @param place of the XDMF file, from which files of HDF5 are seen
    Tree grid_tree(const Grid &grid, const std::filesystem::path &place)
    {
      const auto seen = [&](const std::string &file, const std::string &dataset) {
        return std::filesystem::path(file).lexically_relative(place).string() + ":/" + dataset;
      };
      const FieldMesh &mesh = *grid.mesh;
      Tree             topology, geometry, result;
      topology.put("<xmlattr>.TopologyType", mesh.corners == 8 ? "Hexahedron" : "Quadrilateral");
      topology.put("<xmlattr>.NumberOfElements", mesh.n_all_cells);
      topology.add_child("DataItem", data_item(seen(grid.mesh_file, grid.group + "/cells"), mesh.n_all_cells, mesh.corners, true));
      geometry.put("<xmlattr>.GeometryType", "XYZ");
      geometry.add_child("DataItem", data_item(seen(grid.mesh_file, grid.group + "/points"), mesh.n_all_nodes, 3, false));
      result.put("<xmlattr>.Name", grid.title);
      result.put("<xmlattr>.GridType", "Uniform");
      result.add_child("Topology", topology);
      result.add_child("Geometry", geometry);
      for (const auto &[name, file, dataset, n_columns] : grid.fields)
        result.add_child("Attribute",
                         attribute(name, "Node", n_columns, data_item(seen(file, dataset), mesh.n_all_nodes, n_columns, false)));
      result.add_child("Attribute", attribute("component", "Cell", 1,
                                              data_item(seen(grid.mesh_file, grid.group + "/component"), mesh.n_all_cells, 1, true)));
      return result;
    }

    /// Grids through which ParaView steps.
    class GridList
    {
    public:
      /// @param place of the file, from which files of HDF5 are seen
      GridList(const std::string &name, std::filesystem::path place)
        : place(std::move(place))
      {
        tree.put("<xmlattr>.Name", name);
        tree.put("<xmlattr>.GridType", "Collection");
        tree.put("<xmlattr>.CollectionType", "Temporal");
      }

      void add(const double time, const Grid &grid)
      {
        std::ostringstream value;
        value << std::setprecision(15) << time;
        Tree at, child = grid_tree(grid, place);
        at.put("<xmlattr>.Value", value.str());
        child.add_child("Time", at);
        tree.add_child("Grid", child);
        ++n;
      }

      Tree         tree;
      unsigned int n = 0;

    private:
      const std::filesystem::path place;
    };

    void write_document(const ResultFolder &folder, const std::string &name, const Tree &grid)
    {
      Tree document;
      document.put("Xdmf.<xmlattr>.Version", "2.0");
      document.add_child("Xdmf.Domain.Grid", grid);
      folder.write(name, [&](std::ostream &stream) {
        write_xml(stream, document, boost::property_tree::xml_writer_make_settings<std::string>(' ', 1));
      });
    }
  } // namespace

  XdmfWriter::XdmfWriter(const Model                     &model,
                         const ContactInterface          &interface,
                         const std::vector<unsigned int> &closed_pairs,
                         const ResultFolder              &folder)
    : model(model)
    , folder(folder)
    , contact_faces(contact_face_mesh(model, interface))
    , closed(interface.size(), 0.)
  {
    for (const unsigned int c : closed_pairs)
      closed[c] = 1.;
  }

  const FieldMesh &XdmfWriter::bodies(const std::optional<Component> &component)
  {
    const auto [place, is_new] = meshes.try_emplace(component);
    FieldMesh &mesh            = place->second;
    if (is_new)
      {
        mesh = body_mesh(model, component);
        FieldFile file(folder, mesh_file(component), model.communicator());
        file.add(body_group, mesh);
        if (!component && contact_faces.n_all_cells > 0)
          {
            file.add(contact_group, contact_faces);
            file.add(closed_dataset, on_root(model, closed));
          }
        file.finish();
      }
    return mesh;
  }

  void XdmfWriter::keep(const std::string &name, const Shape &shape)
  {
    written[name] = shape;
    write_document(folder, "modes/" + name + ".xdmf", grid_tree(shape.bodies, "modes"));
    if (shape.contact_faces)
      write_document(folder, "modes/" + name + contact_ending, grid_tree(*shape.contact_faces, "modes"));
  }

  void XdmfWriter::write_mode(const ModeField &mode)
  {
    const double scale = 1. / largest_amplitude(mode.displacement, model.communicator());
    Shape        shape{{mode.title, mesh_file({}), body_group, &bodies({}), {}}, {}};
    FieldFile    file(folder, "modes/" + mode.name + ".h5", model.communicator());
    const auto   add = [&](const char *name, const auto &value) {
      file.add(shape.bodies, name, name, vertex_values(bodies({}), model.free_map(), mode.displacement, value), 3);
    };
    add("displacement_real", [&](const Complex &u) { return scale * u.real(); });
    add("displacement_imag", [&](const Complex &u) { return scale * u.imag(); });
    file.add(shape.bodies, "amplitude", "amplitude", amplitudes(bodies({}), model.free_map(), mode.displacement, scale), 1);

    if (contact_faces.n_all_cells > 0)
      {
        Grid               faces{mode.title, mesh_file({}), contact_group, &contact_faces, {}};
        std::vector<float> re, im;
        for (const Complex &r : mode.reactions)
          {
            re.push_back(scale * r.real());
            im.push_back(scale * r.imag());
          }
        file.add(faces, "normal_reaction_real", "normal_reaction_real", on_root(model, re), 1);
        file.add(faces, "normal_reaction_imag", "normal_reaction_imag", on_root(model, im), 1);
        if (!mode.energy_input.empty())
          file.add(faces, "energy_input", "energy_input", on_root(model, {mode.energy_input.begin(), mode.energy_input.end()}), 1);
        faces.fields.push_back({"closed", mesh_file({}), closed_dataset, 1});
        shape.contact_faces = faces;
      }
    file.describe(mode.title, mesh_file({}));
    file.finish();
    keep(mode.name, shape);
  }

  void XdmfWriter::write_mode(const RealModeField &mode)
  {
    const double     scale = 1. / largest_amplitude(mode.displacement, model.communicator());
    const FieldMesh &mesh  = bodies(mode.component);
    Shape            shape{{mode.title, mesh_file(mode.component), body_group, &mesh, {}}, {}};
    FieldFile        file(folder, "modes/" + mode.name + ".h5", model.communicator());
    file.add(shape.bodies, "displacement", "displacement",
             vertex_values(mesh, model.free_map(), mode.displacement, [&](const double u) { return scale * u; }), 3);
    file.add(shape.bodies, "amplitude", "amplitude", amplitudes(mesh, model.free_map(), mode.displacement, scale), 1);
    file.describe(mode.title, mesh_file(mode.component));
    file.finish();
    keep(mode.name, shape);
  }

  void XdmfWriter::write_list(const std::string &name, const std::vector<ListedMode> &modes)
  {
    const std::vector<double> times = distinct_times(modes);
    GridList                  bodies(name, "."), faces(name, ".");
    for (std::size_t j = 0; j < modes.size(); ++j)
      {
        const Shape &shape = written.at(modes[j].name);
        bodies.add(times[j], shape.bodies);
        if (shape.contact_faces)
          faces.add(times[j], *shape.contact_faces);
      }
    write_document(folder, name + ".xdmf", bodies.tree);
    if (faces.n > 0)
      write_document(folder, name + contact_ending, faces.tree);
  }

  void XdmfWriter::write_animation(const ModeField &mode, const AnimationOptions &options)
  {
    const auto frames = animation_frames(mode, options, model.communicator());
    GridList   list(mode.title, "animations");
    FieldFile  file(folder, "animations/" + mode.name + ".h5", model.communicator());
    for (std::size_t j = 0; j < frames.size(); ++j)
      {
        const AnimationFrame &frame = frames[j];
        Grid                  grid{text(mode.title, ", ", frame.time, " s"), mesh_file({}), body_group, &bodies({}), {}};
        std::ostringstream    dataset;
        dataset << "displacement/" << std::setw(3) << std::setfill('0') << j;
        file.add(grid, "displacement", dataset.str(),
                 vertex_values(bodies({}), model.free_map(), mode.displacement, [&](const Complex &u) { return (frame.turn * u).real(); }),
                 3);
        list.add(frame.time, grid);
      }
    file.describe(mode.title, mesh_file({}));
    file.finish();
    write_document(folder, "animations/" + mode.name + ".xdmf", list.tree);
  }
} // namespace Squeal
