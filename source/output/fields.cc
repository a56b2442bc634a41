// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/output/fields.h>

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Smallest relative distance of times in a list of modes [-], and smallest distance from time zero [Hz].
    constexpr double least_relative_step = 1e-6, least_step = 1e-6;

    /// Resolution of fields as the number of steps per largest displacement or per radian.
    constexpr double steps_of_fields = 65536., steps_of_animations = 4096.;

    /// Rounds to multiples of 1 / @p n for better compression.
    double in_steps(const double n, const double value)
    {
      return std::round(n * value) / n + 0.;
    }

    /// Largest |u| over the dofs of all processes, for scaling fields; one if all displacements are zero.
    template <typename Number>
    double largest_modulus(const std::vector<Number> &displacement, const MPI_Comm communicator)
    {
      double largest = 0.;
      for (const Number &u : displacement)
        largest = std::max<double>(largest, std::abs(u));
      largest = dealii::Utilities::MPI::max(largest, communicator);
      return largest > 0. ? largest : 1.;
    }

    using Partitioner = dealii::Utilities::MPI::Partitioner;

    /// Dofs owned by this process, and ghost dofs of its nodes.
    std::shared_ptr<const Partitioner> dofs_of(const std::vector<Node> &nodes, const RowMap &map)
    {
      std::vector<dealii::types::global_dof_index> dofs;
      for (const Node &node : nodes)
        for (int d = 0; d < 3; ++d)
          node.for_each_dof(d, [&](const int dof, double) { dofs.push_back(dof); });
      std::sort(dofs.begin(), dofs.end());
      dealii::IndexSet own(map.n()), relevant(map.n());
      if (map.n_local() > 0)
        own.add_range(map.number(0), map.number(0) + map.n_local()); // each process owns a contiguous range
      relevant.add_indices(dofs.begin(), dofs.end());
      return std::make_shared<Partitioner>(own, relevant, map.communicator());
    }

    template <typename Number>
    using Vectors = std::vector<std::array<Number, 3>>;

    /// Displacements of the vertices from local rows of the free dofs; zero for clamped dofs. Collective.
    template <typename Number>
    Vectors<Number> vertex_values(const FieldMesh                          &mesh,
                                  const std::shared_ptr<const Partitioner> &dofs,
                                  const std::vector<Number>                &displacement)
    {
      dealii::LinearAlgebra::distributed::Vector<Number> values(dofs);
      std::copy(displacement.begin(), displacement.end(), values.begin());
      values.update_ghost_values();
      Vectors<Number> result(mesh.nodes.size());
      for (std::size_t i = 0; i < result.size(); ++i)
        for (int d = 0; d < 3; ++d)
          mesh.nodes[i].for_each_dof(d, [&](const int dof, const double weight) { result[i][d] += weight * values(dof); });
      return result;
    }

    /// Vector field of value(u) for each displacement component u of the vertices.
    template <typename Number, typename Function>
    VertexField vector_field(const std::string &name, const Vectors<Number> &displacement, const Function &value)
    {
      VertexField result{name, 3, {}};
      for (const auto &vector : displacement)
        for (const Number &u : vector)
          result.values.push_back(static_cast<float>(value(u)));
      return result;
    }

    template <typename Number>
    VertexField amplitude(const Vectors<Number> &displacement, const double scale)
    {
      VertexField result{"amplitude", 1, {}};
      for (const auto &[x, y, z] : displacement)
        result.values.push_back(
          static_cast<float>(in_steps(steps_of_fields, scale * std::sqrt(std::norm(x) + std::norm(y) + std::norm(z)))));
      return result;
    }

    void write_pvd(const ResultFolder &folder, const std::string &name, const std::vector<std::pair<double, std::string>> &files)
    {
      folder.write(name + ".pvd", [&](std::ostream &stream) { dealii::DataOutBase::write_pvd_record(stream, files); });
    }
  } // namespace

  FieldWriter::Stage::Stage(FieldMesh given)
    : mesh(std::move(given))
    , piece(mesh)
  {}

  FieldWriter::FieldWriter(const Model                     &model,
                           const ContactInterface          &interface,
                           const std::vector<unsigned int> &closed_pairs,
                           const ResultFolder              &folder)
    : model(&model)
    , communicator(model.communicator())
    , folder(folder)
    , dofs(dofs_of(model.nodes(), model.free_map()))
    , closed(interface.size(), 0.)
    , contact_faces(contact_face_mesh(model))
  {
    for (const unsigned int c : closed_pairs)
      closed[c] = 1.;
    std::map<std::int64_t, unsigned int> pair_of_node;
    for (unsigned int c = 0; c < interface.size(); ++c)
      {
        areas.push_back(interface[c].area);
        pair_of_node[interface[c].pin_node.number] = c;
      }
    for (const Node &node : contact_faces.mesh.nodes)
      {
        const auto pair = pair_of_node.find(node.number);
        pairs.push_back(pair == pair_of_node.end() ? -1 : static_cast<int>(pair->second));
      }
  }

  FieldWriter::FieldWriter(const std::vector<Node> &points, const RowMap &map, const ResultFolder &folder)
    : model(nullptr)
    , communicator(map.communicator())
    , folder(folder)
    , dofs(dofs_of(points, map))
    , surface(point_mesh(points))
    , contact_faces(FieldMesh())
  {
    stages.emplace(std::nullopt, *surface);
  }

  const FieldWriter::Stage &FieldWriter::bodies(const std::optional<Component> &component)
  {
    auto place = stages.find(component);
    if (place == stages.end())
      place = stages.emplace(component, Stage(body_mesh(*model, component))).first;
    return place->second;
  }

  void FieldWriter::write(const Stage                    &stage,
                          const std::string              &name,
                          const std::string              &title,
                          const std::vector<VertexField> &fields) const
  {
    VtuPiece piece = stage.piece;
    piece.add(fields);
    piece.write(folder, name + ".vtu", title, communicator);
  }

  void FieldWriter::write_mode(const ModeField &mode)
  {
    const double scale  = 1. / largest_modulus(mode.displacement, communicator);
    const Stage &stage  = bodies({});
    const auto   values = vertex_values(stage.mesh, dofs, mode.displacement);
    write(stage, "modes/" + mode.name, mode.title,
          {vector_field("displacement_real", values, [&](const Complex &u) { return in_steps(steps_of_fields, scale * u.real()); }),
           vector_field("displacement_imag", values, [&](const Complex &u) { return in_steps(steps_of_fields, scale * u.imag()); }),
           amplitude(values, scale),
           vector_field("phase", values, [](const Complex &u) { return in_steps(steps_of_fields, std::arg(u)); })});

    std::vector<double> re, im;
    for (const Complex &r : mode.reactions)
      {
        re.push_back(scale * r.real());
        im.push_back(scale * r.imag());
      }
    std::vector<std::pair<const char *, const std::vector<double> *>> fields = {{"normal_reaction_real", &re},
                                                                                {"normal_reaction_imag", &im},
                                                                                {"closed", &closed}};
    if (!mode.energy_input.empty())
      fields.emplace_back("energy_input", &mode.energy_input);
    write_contact("modes/" + mode.name, mode.title, fields);
  }

  void FieldWriter::write_mode(const RealModeField &mode)
  {
    const double scale  = 1. / largest_modulus(mode.displacement, communicator);
    const Stage &stage  = bodies(mode.component);
    const auto   values = vertex_values(stage.mesh, dofs, mode.displacement);
    write(stage, "modes/" + mode.name, mode.title,
          {vector_field("displacement", values, [&](const double u) { return in_steps(steps_of_fields, scale * u); }),
           amplitude(values, scale)});
  }

  void FieldWriter::write_list(const std::string &name, const std::vector<ListedMode> &modes) const
  {
    std::vector<std::pair<double, std::string>> bodies, faces;
    for (const ListedMode &listed : modes)
      {
        const std::string mode = "modes/" + listed.name, contact = mode + "_contact.vtu";
        const double      least = bodies.empty() ? 0. : (1. + least_relative_step) * bodies.back().first + least_step;
        const double      time  = std::max(listed.frequency, least);
        bodies.emplace_back(time, mode + ".vtu");
        if (folder.files().count(contact) > 0)
          faces.emplace_back(time, contact);
      }
    write_pvd(folder, name, bodies);
    if (!faces.empty())
      write_pvd(folder, name + "_contact", faces);
  }

  void FieldWriter::write_animation(const std::string &name, const std::vector<ModeField> &modes, const AnimationOptions &options)
  {
    if (!surface)
      surface.emplace(surface_mesh(*model));
    std::vector<Vectors<Complex>> shapes;
    std::vector<double>           scales;
    for (const ModeField &mode : modes)
      {
        shapes.push_back(vertex_values(surface->mesh, dofs, mode.displacement));
        scales.push_back(1. / largest_modulus(mode.displacement, communicator));
      }
    const unsigned int                          n_frames = options.frames_per_period * options.periods + (options.grows ? 1 : 0);
    std::vector<std::pair<double, std::string>> files;
    for (unsigned int frame = 0; frame < n_frames; ++frame)
      {
        const double             periods = static_cast<double>(frame) / options.frames_per_period;
        std::vector<VertexField> fields;
        for (std::size_t j = 0; j < modes.size(); ++j)
          {
            const double growth = options.grows ? 2. * M_PI * modes[j].lambda.real() / modes[j].lambda.imag() : 0.; // per period
            // Scale by the amplitude at the time when it is largest, to avoid overflow
            const double  largest_at = growth > 0. ? options.periods : 0.;
            const Complex turn       = std::polar(scales[j] * std::exp(growth * (periods - largest_at)), 2. * M_PI * periods);
            fields.push_back(
              vector_field(modes[j].name, shapes[j], [&](const Complex &u) { return in_steps(steps_of_animations, (turn * u).real()); }));
          }
        std::ostringstream file;
        file << name << "_frames/" << std::setw(3) << std::setfill('0') << frame;
        write(*surface, "animations/" + file.str(), {}, fields);
        files.emplace_back(periods, file.str() + ".vtu");
      }
    write_pvd(folder, "animations/" + name, files);
  }

  void FieldWriter::write_contact(const std::string                                                       &name,
                                  const std::string                                                       &title,
                                  const std::vector<std::pair<const char *, const std::vector<double> *>> &fields) const
  {
    std::vector<VertexField> on_vertices;
    for (const auto &[field, values] : fields)
      {
        on_vertices.push_back({field, 1, {}});
        for (const int pair : pairs)
          on_vertices.back().values.push_back(pair < 0 ? 0.f : static_cast<float>((*values)[pair]));
      }
    if (!closed.empty())
      write(contact_faces, name + "_contact", title, on_vertices);
  }

  void FieldWriter::write_contact_state(const ContactField &state)
  {
    const Stage &stage  = bodies({});
    auto         values = vertex_values(stage.mesh, dofs, state.displacement);
    // Clamped dofs move with their backplate
    for (std::size_t i = 0; i < values.size(); ++i)
      for (int d = 0; d < 3; ++d)
        if (const Node &node = stage.mesh.nodes[i]; node.is_clamped())
          values[i][d] = state.backplates[node.component][d];
    write(stage, "sliding_state", {}, {vector_field("displacement", values, [](const double u) { return u; })});

    std::vector<double> pressure;
    for (std::size_t c = 0; c < areas.size(); ++c)
      pressure.push_back(-state.reactions[c] / areas[c]);
    write_contact("sliding_state", {},
                  {{"pressure", &pressure},
                   {"normal_reaction", &state.reactions},
                   {"gap", &state.gaps},
                   {"closed", &closed},
                   {"c_b", &state.radial_damping},
                   {"c_t", &state.sliding_damping}});
  }
} // namespace Squeal
