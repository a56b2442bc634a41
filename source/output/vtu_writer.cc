#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/output/vtu_writer.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/reference_cell.h>
#include <deal.II/numerics/data_out.h>

#include <fcntl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <map>
#include <sstream>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    using Interpretation = DataComponentInterpretation::DataComponentInterpretation;
    const std::vector<Interpretation> vector_field(3, DataComponentInterpretation::component_is_part_of_vector);

    /// A text in the field data of a file, as codes of its characters.
    void write_text(std::ostream &stream, const char *name, const std::string &text)
    {
      stream << "<FieldData>\n<DataArray type=\"String\" Name=\"" << name << "\" NumberOfTuples=\"1\" format=\"ascii\">\n";
      for (const char c : text)
        stream << int(static_cast<unsigned char>(c)) << ' ';
      stream << "0\n</DataArray>\n</FieldData>\n";
    }

    DataOutBase::VtkFlags compressed()
    {
      DataOutBase::VtkFlags flags;
      flags.compression_level = DataOutBase::VtkFlags::best_speed;
      return flags;
    }

    /// Fields on the bodies, of which every process has the cells that it owns.
    class BodyOutput : public DataOut<3>
    {
    public:
      /// Of one component, or of all bodies.
      explicit BodyOutput(const Model &model, const std::optional<Component> component = {})
        : model(model)
      {
        attach_dof_handler(model.dof_handler());
        if (component)
          set_cell_selection([component](const Triangulation<3>::cell_iterator &cell) {
            return cell->is_locally_owned() && (cell->material_id() == 0) == (*component == Component::disc);
          });
      }

      void add(const DofVector &displacement, const char *name)
      {
        add_data_vector(displacement, std::vector<std::string>(3, name), type_dof_data, vector_field);
      }

      /**
       * Writes one file with the cells of all processes, and a @p title unless it is empty; all must call. Unlike deal.II's own, it tells why
       * a file could not be written.
       */
      void write(const ResultFolder &folder, const std::string &name, const std::string &title = {})
      {
        build_patches(model.mapping(), model.degree());
        std::ostringstream piece;
        if (!get_patches().empty())
          DataOutBase::write_vtu_main(get_patches(), get_dataset_names(), get_nonscalar_data_ranges(), compressed(), piece);
        std::ostringstream header, footer;
        DataOutBase::write_vtu_header(header, compressed());
        if (!title.empty())
          write_text(header, "mode", title);
        DataOutBase::write_vtu_footer(footer);
        write_pieces(folder, name, header.str(), piece.str(), footer.str());
      }

    private:
      /// Process 0 writes the pieces of all, of which it has one at a time.
      void write_pieces(const ResultFolder &folder,
                        const std::string  &name,
                        const std::string  &header,
                        const std::string  &piece,
                        const std::string  &footer) const
      {
        const MPI_Comm communicator = model.communicator();
        const auto     path         = folder.begin_file(name);
        if (model.free_map().rank() != 0)
          {
            const unsigned long size = piece.size();
            MPI_Send(&size, 1, MPI_UNSIGNED_LONG, 0, 0, communicator);
            MPI_Send(piece.data(), static_cast<int>(size), MPI_CHAR, 0, 0, communicator);
            return;
          }
        const auto append = [&](const std::string &text) {
          if (const int problem = write_file(path, O_APPEND, {text}, false); problem != 0)
            throw FileError(std::string("the file cannot be written: ") + std::strerror(problem), "file " + folder.name() + "/" + name,
                            "check permissions and free space");
        };
        append(header + piece);
        for (int process = 1; process < model.free_map().n_processes(); ++process)
          {
            unsigned long size;
            MPI_Recv(&size, 1, MPI_UNSIGNED_LONG, process, 0, communicator, MPI_STATUS_IGNORE);
            std::string other(size, ' ');
            MPI_Recv(other.data(), static_cast<int>(size), MPI_CHAR, process, 0, communicator, MPI_STATUS_IGNORE);
            append(other);
          }
        append(footer);
        folder.end_file(name);
      }

      const Model &model;
    };
  } // namespace

  VtuWriter::VtuWriter(const Model                     &model,
                       const ContactInterface          &interface,
                       const std::vector<unsigned int> &closed_pairs,
                       const ResultFolder              &folder)
    : model(model)
    , interface(interface)
    , folder(folder)
    , components(model.triangulation().n_active_cells())
    , closed(interface.size(), 0.)
  {
    for (const unsigned int c : closed_pairs)
      closed[c] = 1.;
    for (const auto &cell : model.triangulation().active_cell_iterators())
      components(cell->active_cell_index()) = cell->material_id();

    // Vertices of the pins' contact faces are contact nodes; nodes between them (degree 2) are not shown
    std::map<std::int64_t, unsigned int> pair_of_node;
    for (unsigned int c = 0; c < interface.size(); ++c)
      pair_of_node[interface[c].pin_node.number] = c;
    const auto                              &ids = model.surface_ids(PhysicalNames::pin_contact);
    std::vector<std::array<unsigned int, 4>> faces_here;
    for (const auto &cell : model.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && ids.count(face->boundary_id()) > 0)
            {
              faces_here.emplace_back();
              for (unsigned int v = 0; v < 4; ++v)
                faces_here.back()[v] = pair_of_node.at(model.nodes()[model.node_of_dof(face->vertex_dof_index(v, 0))].number);
            }
    for (const auto &faces : Utilities::MPI::gather(model.communicator(), faces_here))
      contact_faces.insert(contact_faces.end(), faces.begin(), faces.end());
  }

  template <typename Number, typename Function>
  DofVector VtuWriter::dof_vector(const std::vector<Number> &displacement, const Function &value) const
  {
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(model.dof_handler(), relevant);
    DofVector result(model.dof_handler().locally_owned_dofs(), relevant, model.communicator());
    for (const auto dof : result.locally_owned_elements())
      if (const int row = model.free_map().place(model.free_dof(dof)); row >= 0)
        result(dof) = value(displacement[row]);
    result.update_ghost_values();
    return result;
  }

  void VtuWriter::write_mode(const ModeField &mode)
  {
    using Complex      = std::complex<double>;
    const double scale = 1. / largest_amplitude(mode.displacement, model.communicator());
    const auto   re    = dof_vector(mode.displacement, [&](const Complex &u) { return scale * u.real(); });
    const auto   im    = dof_vector(mode.displacement, [&](const Complex &u) { return scale * u.imag(); });
    const auto   mod   = dof_vector(mode.displacement, [&](const Complex &u) { return scale * std::abs(u); });
    const auto   arg   = dof_vector(mode.displacement, [](const Complex &u) { return std::arg(u); });

    BodyOutput output(model);
    output.add(re, "displacement_real");
    output.add(im, "displacement_imag");
    output.add(mod, "amplitude");
    output.add(arg, "phase");
    output.add_data_vector(components, "component", DataOut<3>::type_cell_data);
    output.write(folder, "modes/" + mode.name + ".vtu", mode.title);

    std::vector<double> reactions_re, reactions_im;
    for (const Complex &r : mode.reactions)
      {
        reactions_re.push_back(scale * r.real());
        reactions_im.push_back(scale * r.imag());
      }
    std::vector<std::pair<const std::vector<double> *, const char *>> fields = {{&reactions_re, "normal_reaction_real"},
                                                                                {&reactions_im, "normal_reaction_imag"},
                                                                                {&closed, "closed"}};
    if (!mode.energy_input.empty())
      fields.emplace_back(&mode.energy_input, "energy_input");
    write_contact("modes/" + mode.name + "_contact.vtu", fields);
  }

  void VtuWriter::write_mode(const RealModeField &mode)
  {
    const double scale = 1. / largest_amplitude(mode.displacement, model.communicator());
    const auto   u     = dof_vector(mode.displacement, [&](const double value) { return scale * value; });
    const auto   mod   = dof_vector(mode.displacement, [&](const double value) { return scale * std::abs(value); });

    BodyOutput output(model, mode.component);
    output.add(u, "displacement");
    output.add(mod, "amplitude");
    output.add_data_vector(components, "component", DataOut<3>::type_cell_data);
    output.write(folder, "modes/" + mode.name + ".vtu", mode.title);
  }

  void VtuWriter::write_list(const std::string &name, const std::vector<ListedMode> &modes)
  {
    const std::vector<double>                   times = distinct_times(modes);
    std::vector<std::pair<double, std::string>> files;
    for (std::size_t j = 0; j < modes.size(); ++j)
      files.emplace_back(times[j], "modes/" + modes[j].name + ".vtu");
    folder.write(name + ".pvd", [&](std::ostream &stream) { DataOutBase::write_pvd_record(stream, files); });
  }

  void VtuWriter::write_contact(const std::string                                                       &file,
                                const std::vector<std::pair<const std::vector<double> *, const char *>> &fields) const
  {
    std::vector<DataOutBase::Patch<2, 3>> patches(contact_faces.size());
    std::vector<std::string>              names;
    for (const auto &[values, name] : fields)
      names.emplace_back(name);
    for (std::size_t face = 0; face < patches.size(); ++face)
      {
        patches[face].patch_index    = face;
        patches[face].reference_cell = ReferenceCells::Quadrilateral;
        patches[face].data.reinit(fields.size(), 4);
        for (unsigned int v = 0; v < 4; ++v)
          {
            const unsigned int pair   = contact_faces[face][v];
            const auto &[x, y, z]     = interface[pair].pin_node.position;
            patches[face].vertices[v] = {x, y, z};
            for (std::size_t f = 0; f < fields.size(); ++f)
              patches[face].data(f, v) = (*fields[f].first)[pair];
          }
      }
    folder.write(file, [&](std::ostream &stream) { DataOutBase::write_vtu(patches, names, {}, compressed(), stream); });
  }

  void VtuWriter::write_contact_state(const ContactField &state) const
  {
    // Clamped dofs follow their backplate
    DofVector u = dof_vector(state.displacement, [](const double value) { return value; });
    for (unsigned int k = 0; k < 3; ++k)
      for (const auto dof : DoFTools::extract_dofs(model.dof_handler(), ComponentMask(std::vector<bool>{k == 0, k == 1, k == 2})))
        if (u.locally_owned_elements().is_element(dof) && model.free_dof(dof) < 0)
          u(dof) = state.backplates[model.nodes()[model.node_of_dof(dof)].component][k];
    u.update_ghost_values();

    BodyOutput bodies(model);
    bodies.add(u, "displacement");
    bodies.add_data_vector(components, "component", DataOut<3>::type_cell_data);
    bodies.write(folder, "sliding_state.vtu");

    std::vector<double> pressure;
    for (unsigned int c = 0; c < interface.size(); ++c)
      pressure.push_back(-state.reactions[c] / interface[c].area);
    write_contact("sliding_state_contact.vtu", {{&pressure, "pressure"},
                                                {&state.reactions, "normal_reaction"},
                                                {&state.gaps, "gap"},
                                                {&closed, "closed"},
                                                {&state.radial_damping, "c_b"},
                                                {&state.sliding_damping, "c_t"}});
  }

  void VtuWriter::write_animation(const ModeField &mode, const AnimationOptions &options)
  {
    std::vector<std::pair<double, std::string>> files;
    for (const AnimationFrame &frame : animation_frames(mode, options, model.communicator()))
      {
        const auto u = dof_vector(mode.displacement, [&](const std::complex<double> &value) { return (frame.turn * value).real(); });

        BodyOutput output(model);
        output.add(u, "displacement");

        std::ostringstream name;
        name << mode.name << "_frames/" << std::setw(3) << std::setfill('0') << files.size() << ".vtu";
        output.write(folder, "animations/" + name.str());
        files.emplace_back(frame.time, name.str());
      }
    folder.write("animations/" + mode.name + ".pvd", [&](std::ostream &stream) { DataOutBase::write_pvd_record(stream, files); });
  }
} // namespace Squeal
