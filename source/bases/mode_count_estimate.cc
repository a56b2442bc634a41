#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/bases/mode_count_estimate.h>
#include <squeal/geometry/faces.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// Orders along the height that are summed one by one; of more, samples.
    constexpr double most_orders = 1000.;
    /// Edge term of a wave in a region with free edges, and of a thin plate in bending [-].
    constexpr double free_edge = 1., free_plate_edge = 1.7126;
    /// Shear correction of plates and bars [-].
    constexpr double shear_correction = 5. / 6.;

    /// Of the edges of the elements of a body [m].
    double longest_edge(const HexMesh &mesh, const std::vector<HexFace> &faces, const unsigned int volume)
    {
      double longest = 0.;
      for (const HexFace &face : faces)
        if (face.volume == volume)
          for (unsigned int i = 0; i < 4; ++i)
            longest = std::max(longest, mesh.points[face.nodes[i]].distance(mesh.points[face.nodes[(i + 1) % 4]]));
      return longest;
    }

    /// Wave speeds of a material [m/s].
    struct WaveSpeeds
    {
      explicit WaveSpeeds(const Material &material)
        : shear(std::sqrt(material.young_modulus / (2. * (1. + material.poisson_ratio) * material.density)))
        , bar(std::sqrt(material.young_modulus / material.density))
        , plate(bar / std::sqrt(1. - material.poisson_ratio * material.poisson_ratio))
      {}

      double shear, bar, plate;
    };

    /// Wave number of bending, ω_b = @p thin k² and ω_s = @p shear k.
    double bending_wave_number(const double omega, const double thin, const double shear)
    {
      const double a = omega / shear, b = omega / thin;
      return std::sqrt(0.5 * (a * a + std::hypot(a * a, 2. * b)));
    }

    /// S, mean area of the sections across z [m²].
    double area(const BodyShape &body)
    {
      return body.volume / body.height;
    }

    /// N(k).
    double plane_modes(const BodyShape &body, const double wave_number, const double edge)
    {
      return (area(body) * wave_number * wave_number + edge * body.outline * wave_number) / (4. * M_PI);
    }

    /**
     * Modes across the section for all orders along the height: k_n = (n − @p offset) π / h, n = 1, 2, ..., below
     * @p wave_number = ω / c.
     */
    double section_modes(const BodyShape &body, const double wave_number, const double offset)
    {
      const double n_orders = std::floor(wave_number * body.height / M_PI + offset);
      if (!(n_orders >= 1.))
        return 0.;
      const double n_samples = std::min(n_orders, most_orders), width = n_orders / n_samples;
      double       sum = 0.;
      for (double i = 0.; i < n_samples; ++i)
        {
          const double k_n = ((i + 0.5) * width + 0.5 - offset) * M_PI / body.height;
          sum += width * plane_modes(body, std::sqrt(std::max(0., wave_number * wave_number - k_n * k_n)), free_edge);
        }
      return sum;
    }

    double disc_modes(const BodyShape &body, const WaveSpeeds &speed, const double omega)
    {
      const double thin    = speed.plate * body.height / std::sqrt(12.);
      const double bending = bending_wave_number(omega, thin, std::sqrt(shear_correction) * speed.shear);
      double       n       = 3. + plane_modes(body, bending, free_plate_edge);
      for (const double c : {speed.shear, speed.plate})
        n += plane_modes(body, omega / c, free_edge);
      for (const double c : {speed.shear, speed.shear, speed.plate})
        n += section_modes(body, omega / c, 0.);
      return n;
    }

    double pin_modes(const BodyShape &body, const WaveSpeeds &speed, const double omega)
    {
      // Fixed at the back, free to slide in front: k_n = (n − ½) π / h; along the axis both ends are fixed.
      const auto   orders  = [&](const double k, const double offset) { return std::floor(k * body.height / M_PI + offset); };
      const double radius  = std::sqrt(area(body) / (4. * M_PI)); // of gyration, of a round section
      const double bending = bending_wave_number(omega, speed.bar * radius, std::sqrt(shear_correction) * speed.shear);
      return 2. * orders(bending, 0.5) + orders(omega / speed.shear, 0.5) + orders(omega / speed.bar, 0.) +
             section_modes(body, omega / speed.shear, 0.5) + section_modes(body, omega / speed.plate, 0.5) +
             section_modes(body, omega / speed.shear, 0.);
    }
  } // namespace

  std::vector<BodyShape> body_shapes(const HexMesh &mesh)
  {
    constexpr double       infinity = std::numeric_limits<double>::infinity();
    std::vector<BodyShape> bodies;
    std::vector<Range>     z(mesh.volume_names.size(), {infinity, -infinity});
    for (const std::string &name : mesh.volume_names)
      bodies.push_back({name, infinity, 0., 0., 0., 0., 0.});
    const std::vector<unsigned int> volume_of_node = volume_of_nodes(mesh);
    for (std::size_t node = 0; node < mesh.points.size(); ++node)
      {
        const HexMesh::Point &p      = mesh.points[node];
        BodyShape            &body   = bodies[volume_of_node[node]];
        Range                &extent = z[volume_of_node[node]];
        const double          radius = std::hypot(p[0], p[1]);
        body.inner_radius            = std::min(body.inner_radius, radius);
        body.outer_radius            = std::max(body.outer_radius, radius);
        extent                       = {std::min(extent.least, p[2]), std::max(extent.greatest, p[2])};
      }
    for (std::size_t b = 0; b < bodies.size(); ++b)
      bodies[b].height = z[b].greatest - z[b].least;
    for (const HexFace &face : outer_faces(mesh))
      {
        BodyShape &body             = bodies[face.volume];
        const auto [centre, normal] = face_geometry(mesh, face.nodes);
        body.volume += centre * normal / 3.; // Gauss' theorem
        if (std::abs(normal[2]) < 0.5 * normal.norm())
          body.outline += normal.norm() / body.height;
      }
    for (const HexMesh::Quadrilateral &face : mesh.quadrilaterals)
      if (mesh.surface_names[face.surface] == PhysicalNames::pin_contact || mesh.surface_names[face.surface] == PhysicalNames::disc_contact)
        bodies[volume_of_node[face.nodes[0]]].contact_area += face_geometry(mesh, face.nodes).area_normal.norm();
    return bodies;
  }

  double expected_number_of_modes(const HexMesh &mesh, const MaterialParameters &materials, const double largest_circular_frequency)
  {
    double n = 0.;
    for (const BodyShape &body : body_shapes(mesh))
      {
        const WaveSpeeds speed(materials.of(body.name));
        n += body.name == PhysicalNames::disc ? disc_modes(body, speed, largest_circular_frequency) :
                                                pin_modes(body, speed, largest_circular_frequency);
      }
    return n;
  }

  void check_wave_resolution(const HexMesh            &mesh,
                             const MaterialParameters &materials,
                             const unsigned int        degree,
                             const double              largest_circular_frequency)
  {
    const std::vector<HexFace> faces = all_faces(mesh);
    for (unsigned int volume = 0; volume < mesh.volume_names.size(); ++volume)
      {
        const std::string &name      = mesh.volume_names[volume];
        const double       frequency = hertz(largest_circular_frequency);
        const double       wave      = WaveSpeeds(materials.of(name)).shear / frequency;
        const double       edge      = longest_edge(mesh, faces, volume);
        if (wave * degree >= edge)
          continue;
        throw ParameterError(text("shear waves of ", frequency, " Hz are ", wave, " m long in ", name, ", whose elements measure up to ",
                                  edge, " m: the mesh does not resolve the modes of the band"),
                             "parameter Band/Maximum frequency",
                             text("lower it below ", wave * degree / edge * frequency, " Hz, choose smaller elements, or correct ",
                                  name == PhysicalNames::disc ? "Disc" : "Pin", " material/Young modulus and Density"));
      }
  }
} // namespace Squeal
