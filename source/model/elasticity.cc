// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/model/cell_integrals.h>
#include <squeal/model/cell_stiffness.h>
#include <squeal/model/elasticity.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>

#include <algorithm>
#include <functional>
#include <map>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Rejects an inverted element; curved edges may invert an element that is valid with straight edges.
    void check_orientation(const ElementValues &values, const std::string &volume)
    {
      Point<3> centre;
      for (unsigned int i = 0; i < values.n_nodes(); ++i)
        centre += values.node(i) / double(values.n_nodes());
      for (unsigned int q = 0; q < values.n_points(); ++q)
        if (!(values.JxW(q) > 0.))
          throw MeshError("the element is inverted: its Jacobian is not positive everywhere",
                          text("volume ", volume, ", element with centre (", centre, ") m"),
                          "correct this element of the mesh; at curved boundaries, use smaller elements (Geometry/Nodes per pin face, "
                          "Geometry/Element size), or choose a Discretization/Element other than quadratic");
    }

    using Matrix = std::shared_ptr<const SparseMatrix>;

    enum Direction
    {
      radial,
      tangential,
      axial,
      all
    };

    /// Unit vector of a direction about the z axis.
    Tensor<1, 3> unit_vector(const int direction, const Point<3> &x)
    {
      const double r = std::hypot(x[0], x[1]);
      return direction == axial      ? Tensor<1, 3>({0., 0., 1.}) :
             direction == tangential ? Tensor<1, 3>({-x[1] / r, x[0] / r, 0.}) :
                                       Tensor<1, 3>({x[0] / r, x[1] / r, 0.});
    }

    std::vector<const NodalElement *> cells_of_volume(const Model &model, const unsigned int volume)
    {
      std::vector<const NodalElement *> result;
      for (const Cell &cell : model.cells())
        if (cell.volume == volume)
          result.push_back(&cell);
      return result;
    }

    /// K_e of a mounted surface in a direction.
    Matrix mount_matrix(const Model &model, const std::string &surface, const int direction)
    {
      const std::vector<const Face *> faces = model.faces_of(surface);
      const ElementIntegral           mount = [direction](const ElementValues &values, FullMatrix<double> &K) {
        if (direction == all)
          {
            add_in_each_direction(values, K,
                                            [&](const auto i, const auto j, const auto q) { return values.value(i, q) * values.value(j, q); });
            return;
          }
        for (unsigned int q = 0; q < values.n_points(); ++q)
          {
            const Tensor<1, 3> e = unit_vector(direction, values.point(q));
            for (unsigned int i = 0; i < K.m(); ++i)
              for (unsigned int j = 0; j < K.m(); ++j)
                K(i, j) += e[i % 3] * e[j % 3] * values.value(i / 3, q) * values.value(j / 3, q) * values.JxW(q);
          }
      };
      return assemble(model, {faces.begin(), faces.end()}, {mount})[0];
    }
  } // namespace

  namespace BodyParameter
  {
    std::string young_modulus(const std::string &volume)
    {
      return "Young's modulus, " + volume;
    }

    std::string density(const std::string &volume)
    {
      return "density, " + volume;
    }

    std::string rayleigh_alpha(const std::string &volume)
    {
      return "Rayleigh alpha, " + volume;
    }

    std::string rayleigh_beta(const std::string &volume)
    {
      return "Rayleigh beta, " + volume;
    }
  } // namespace BodyParameter

  std::vector<MountParameter> mount_parameters(const MaterialParameters &materials)
  {
    constexpr const char       *directions[] = {"radial", "tangential", "axial"};
    std::vector<MountParameter> result;
    const auto add = [&](const std::vector<Mount> &mounts, const char *list, const char *quantity, const char *unit, const int power) {
      for (const Mount &mount : mounts)
        for (const int d : {radial, tangential, axial})
          if (const double value = mount.along(d); value != 0.)
            result.push_back({text(directions[d], ' ', quantity, ", ", mount.surface),
                              text("Mounts/", list, ": ", mount.surface, ' ', directions[d]), unit, value, power, mount.surface, d});
    };
    add(materials.mounts, "Elastic mounts", "stiffness", "N/m^3", 0);
    add(materials.dashpots, "Dashpots", "dashpots", "N s/m^3", 1);
    for (const SurfaceMass &mass : materials.masses)
      if (mass.mass != 0.)
        result.push_back(
          {"added mass, " + mass.surface, "Mounts/Added masses: " + mass.surface, "kg/m^2", mass.mass, 2, mass.surface, all});
    return result;
  }

  ParameterValues body_values(const Model &model, const MaterialParameters &materials)
  {
    ParameterValues result;
    for (const std::string &volume : model.volume_names())
      {
        const Material material                       = materials.of(volume);
        result[BodyParameter::young_modulus(volume)]  = {material.young_modulus};
        result[BodyParameter::density(volume)]        = {material.density};
        result[BodyParameter::rayleigh_alpha(volume)] = {material.rayleigh_alpha};
        result[BodyParameter::rayleigh_beta(volume)]  = {material.rayleigh_beta};
      }
    for (const MountParameter &mount : mount_parameters(materials))
      result[mount.name] = {mount.value};
    return result;
  }

  std::vector<Term> volume_terms(const Model &model, const unsigned int volume, const Material &material)
  {
    const ElasticLaw      law(material);
    const std::string    &name      = model.volume_names()[volume];
    const ElementIntegral stiffness = [&](const ElementValues &values, FullMatrix<double> &K) {
      check_orientation(values, name);
      add_stiffness(values, model.element(), law, K);
    };
    const ElementIntegral mass = [](const ElementValues &values, FullMatrix<double> &M) {
      add_in_each_direction(values, M,
                            [&values](const auto i, const auto j, const auto q) { return values.value(i, q) * values.value(j, q); });
    };
    const auto  matrices = assemble(model, cells_of_volume(model, volume), {stiffness, mass});
    const auto &K = matrices[0], &M = matrices[1];

    const std::string young = BodyParameter::young_modulus(name), density = BodyParameter::density(name),
                      alpha = BodyParameter::rayleigh_alpha(name), beta = BodyParameter::rayleigh_beta(name);
    return {sparse_term("stiffness, " + name, 0, {1., {{young, 1}}}, K), sparse_term("mass, " + name, 2, {1., {{density, 1}}}, M),
            sparse_term("damping by stiffness, " + name, 1, {1., {{beta, 1}, {young, 1}}}, K),
            sparse_term("damping by mass, " + name, 1, {1., {{alpha, 1}, {density, 1}}}, M)};
  }

  BodyTerms body_terms(const Model &model, const MaterialParameters &materials)
  {
    BodyTerms bodies{{}, body_values(model, materials)};
    for (unsigned int volume = 0; volume < model.volume_names().size(); ++volume)
      for (Term &term : volume_terms(model, volume, materials.of(model.volume_names()[volume])))
        bodies.terms.push_back(std::move(term));
    std::map<std::pair<std::string, int>, Matrix> matrices; // by surface and direction, for springs and dashpots
    for (const MountParameter &mount : mount_parameters(materials))
      {
        auto &matrix = matrices[{mount.surface, mount.direction}];
        if (!matrix)
          matrix = mount_matrix(model, mount.surface, mount.direction);
        bodies.terms.push_back(
          sparse_term("mount, " + mount.name, mount.power, {1., {{mount.name, 1}}}, matrix, Symmetry::symmetric, TermKind::mount));
      }
    return bodies;
  }

  void add_rotation(BodyTerms &bodies, const Model &model, const double angular_velocity)
  {
    const auto turned = [](const ElementValues &values, const unsigned int i, const unsigned int q) { // ∂_θ of a shape function
      const Point<3> &x = values.point(q);
      return x[0] * values.gradient(i, q)[1] - x[1] * values.gradient(i, q)[0];
    };
    const ElementIntegral gyroscopic = [turned](const ElementValues &values, FullMatrix<double> &G) {
      add_in_each_direction(values, G, [&](const auto i, const auto j, const auto q) {
        return values.value(i, q) * turned(values, j, q) - turned(values, i, q) * values.value(j, q);
      });
    };
    const ElementIntegral convective = [turned](const ElementValues &values, FullMatrix<double> &N) {
      add_in_each_direction(values, N,
                            [&](const auto i, const auto j, const auto q) { return turned(values, i, q) * turned(values, j, q); });
    };
    const std::string speed = BodyParameter::angular_velocity;
    bodies.values[speed]    = {angular_velocity};
    for (const unsigned int volume : model.volumes_of(0))
      {
        const std::string &name     = model.volume_names()[volume];
        const std::string  density  = BodyParameter::density(name);
        const auto         matrices = assemble(model, cells_of_volume(model, volume), {gyroscopic, convective});
        bodies.terms.push_back(
          sparse_term("gyroscopic forces, " + name, 1, {1., {{density, 1}, {speed, 1}}}, matrices[0], Symmetry::skew, TermKind::rotation));
        bodies.terms.push_back(sparse_term("convective stiffness, " + name, 0, {-1., {{density, 1}, {speed, 2}}}, matrices[1],
                                           Symmetry::symmetric, TermKind::rotation));
      }
  }
} // namespace Squeal
