#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/disc_axis.h>
#include <squeal/geometry/faces.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Squeal
{
  namespace
  {
    using Vector = dealii::Tensor<1, 3>;

    // A face fits an axis if rotation moves it along its normal by less than this [radius].
    constexpr double fitting_motion = 5e-4;

    // Lateral faces: normals further from the axis than 60°.
    constexpr double largest_lateral_cosine = 0.5;

    // Motion beyond which a face hardly counts: from large to fitting_motion, lest the first fit decide
    constexpr double first_scale = 0.1, scale_decrease = 0.8;
    constexpr int    n_weightings = 40;

    // What check_disc_axis() does not mind
    constexpr double negligible_angle  = 0.1 * dealii::numbers::PI / 180.;
    constexpr double negligible_offset = 1e-3; ///< [radius]
    constexpr double clearly_rounder   = 0.1;  ///< share of the area

    struct Face
    {
      Vector place, normal; ///< from the centre of the disc [radius]; unit normal
      double area;
    };

    struct Surface
    {
      std::vector<Face> faces;
      Vector            centre; ///< [m]
      double            radius; ///< unit of length [m]
    };

    /// A rotation about an axis: velocity a × x + v.
    struct Motion
    {
      Vector a, v;

      double normal_velocity(const Face &face) const
      {
        return face.normal * (cross_product_3d(a, face.place) + v);
      }
    };

    Surface disc_surface(const HexMesh &mesh)
    {
      Surface                   surface;
      std::vector<FaceGeometry> geometry;
      double                    area = 0.;
      for (const HexFace &face : outer_faces(mesh))
        if (mesh.volume_names[face.volume] == PhysicalNames::disc)
          {
            geometry.push_back(face_geometry(mesh, face.nodes));
            const double size = geometry.back().area_normal.norm();
            surface.centre += size * geometry.back().centre;
            area += size;
          }
      surface.centre /= area;
      surface.radius = std::sqrt(area / (2. * dealii::numbers::PI));
      for (const auto &[place, normal] : geometry)
        if (normal.norm() > 0.)
          surface.faces.push_back({(place - surface.centre) / surface.radius, normal / normal.norm(), normal.norm() / area});
      return surface;
    }

    /// The motion with |a| = 1 of least weighted normal velocity.
    Motion least_motion(const Surface &surface, const std::vector<double> &weights)
    {
      // Quadratic form of (a, v), with n·(a × x) = a·(x × n); v eliminated
      dealii::SymmetricTensor<2, 3> aa, vv;
      dealii::Tensor<2, 3>          av;
      for (std::size_t i = 0; i < weights.size(); ++i)
        {
          const Face  &face = surface.faces[i];
          const double w    = weights[i] * face.area;
          const Vector q    = cross_product_3d(face.place, face.normal);
          aa += w * symmetrize(outer_product(q, q));
          vv += w * symmetrize(outer_product(face.normal, face.normal));
          av += w * outer_product(q, face.normal);
        }
      constexpr double                    regularisation = 1e-12; // of a surface that may slide along a direction
      const auto                          inverse = dealii::Tensor<2, 3>(invert(vv + regularisation * dealii::unit_symmetric_tensor<3>()));
      const dealii::SymmetricTensor<2, 3> S       = symmetrize(dealii::Tensor<2, 3>(aa) - av * inverse * transpose(av));
      const Vector                        a       = eigenvectors(S, dealii::SymmetricTensorEigenvectorMethod::jacobi)[2].second;
      return {a, -(inverse * (transpose(av) * a))};
    }

    /**
     * Share of the area that a motion leaves where it is: of the lateral faces, which tell where an axis is, or of
     * the others, which tell how it is inclined, whichever is less.
     */
    double fitting_share(const Surface &surface, const Motion &motion)
    {
      double all[2] = {0., 0.}, fitting[2] = {0., 0.};
      for (const Face &face : surface.faces)
        {
          const bool is_lateral = std::abs(face.normal * motion.a) < largest_lateral_cosine;
          all[is_lateral] += face.area;
          fitting[is_lateral] += std::abs(motion.normal_velocity(face)) < fitting_motion ? face.area : 0.;
        }
      double least = 1.;
      for (const bool is_lateral : {false, true})
        if (all[is_lateral] > 0.)
          least = std::min(least, fitting[is_lateral] / all[is_lateral]);
      return least;
    }

    std::string print(const Vector &vector, const double negligible)
    {
      const auto component = [&](const unsigned int d) { return std::abs(vector[d]) < negligible ? 0. : vector[d]; };
      return text("(", component(0), ", ", component(1), ", ", component(2), ")");
    }
  } // namespace

  DiscAxis find_disc_axis(const HexMesh &mesh)
  {
    const Surface       surface = disc_surface(mesh);
    std::vector<double> weights(surface.faces.size(), 1.);
    Motion              motion = least_motion(surface, weights);
    double              scale  = first_scale;
    for (int i = 0; i < n_weightings; ++i)
      {
        for (std::size_t f = 0; f < weights.size(); ++f)
          weights[f] = 1. / (1. + std::pow(motion.normal_velocity(surface.faces[f]) / scale, 2));
        motion = least_motion(surface, weights);
        scale  = std::max(fitting_motion, scale_decrease * scale);
      }

    // The point of the axis next to the centre of the disc; a sense that reads well
    const Vector to_axis = surface.radius * cross_product_3d(motion.a, motion.v);
    const Vector centre  = surface.centre + to_axis;
    unsigned int largest = 2;
    for (const unsigned int d : {0, 1})
      if (std::abs(motion.a[d]) > std::abs(motion.a[largest]) + 1e-6)
        largest = d;
    const double sense = motion.a[largest] < 0. ? -1. : 1.;

    const Vector z({0., 0., 1.});
    DiscAxis     axis;
    axis.direction     = sense * motion.a;
    axis.centre        = HexMesh::Point(centre);
    axis.angle         = std::atan2(cross_product_3d(z, motion.a).norm(), std::abs(z * motion.a));
    axis.offset        = std::hypot(centre[0], centre[1]);
    axis.round         = fitting_share(surface, motion);
    axis.round_about_z = fitting_share(surface, {z, cross_product_3d(z, surface.centre) / surface.radius});
    return axis;
  }

  void check_disc_axis(const DiscAxis &axis, const HexMesh &mesh, const std::string &where)
  {
    double radius = 0.; // largest distance of a node of the disc from z [m]
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      if (mesh.volume_names[hexahedron.volume] == PhysicalNames::disc)
        for (const unsigned int node : hexahedron.nodes)
          radius = std::max(radius, std::hypot(mesh.points[node][0], mesh.points[node][1]));
    const bool is_elsewhere = axis.angle > negligible_angle || axis.offset > negligible_offset * radius;
    if (is_elsewhere && axis.round > axis.round_about_z + clearly_rounder)
      throw MeshError("The disc turns about the z axis, but it is round about the axis through " + print(axis.centre, 1e-6 * radius) +
                        " m in direction " + print(axis.direction, 1e-6),
                      where,
                      "move and turn all volumes so that the axis of the disc is the z axis, e.g. by Translate and Rotate in the geometry");
  }
} // namespace Squeal
