// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/mesh.h>
#include <squeal/parameters/materials.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

namespace Squeal
{
  namespace
  {
    /// 64-bit FNV-1a hash.
    std::uint64_t hash(const std::string_view bytes)
    {
      std::uint64_t result = 0xcbf29ce484222325ull;
      for (const char byte : bytes)
        result = (result ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
      return result;
    }
  } // namespace

  std::string cell_counts(const Mesh &mesh)
  {
    std::map<Shape, std::size_t> numbers;
    for (const Mesh::Cell &cell : mesh.cells)
      ++numbers[cell.shape];
    std::string result;
    for (const auto &[shape, n] : numbers)
      result += text(result.empty() ? "" : ", ", n, ' ', topology(shape).name);
    return result.empty() ? "no cells" : result;
  }

  std::string describe_cell(const Mesh &mesh, const std::size_t cell)
  {
    const Mesh::Point c = centre(mesh, mesh.cells[cell]);
    return text("element ", mesh.element_tags.empty() ? cell : mesh.element_tags[cell], " of volume '",
                mesh.volume_names[mesh.cells[cell].volume], "', near (", c[0], ", ", c[1], ", ", c[2], ") m");
  }

  std::uint64_t checksum(const Mesh &mesh)
  {
    double size = 0.;
    for (const Mesh::Point &point : mesh.points)
      size = std::max(size, point.norm());
    // Use a power of ten, so that rounding errors of the size do not change the checksum
    const double unit = 1e-8 * std::pow(10., std::floor(std::log10(size)));
    std::string  places;
    for (const Mesh::Point &point : mesh.points)
      for (unsigned int d = 0; d < 3; ++d)
        places += std::to_string(std::llround(point[d] / unit)) + ' ';
    return hash(places);
  }

  // ------------------------------------------------------------------ bodies

  namespace
  {
    /// Common beginning of all names, up to the end of a word; may be empty.
    std::string common_words(const std::vector<std::string> &names)
    {
      const auto is_separator = [](const char c) { return std::string_view("_.- ").find(c) != std::string_view::npos; };
      const auto ends_word    = [&](const std::size_t length) {
        return std::all_of(names.begin(), names.end(),
                              [&](const std::string &name) { return length == name.size() || is_separator(name[length]); });
      };
      const std::string &first  = names[0];
      std::size_t        length = first.size();
      for (const std::string &name : names)
        length = std::min<std::size_t>(length, std::mismatch(first.begin(), first.end(), name.begin(), name.end()).first - first.begin());
      while (length > 0 && (is_separator(first[length - 1]) || !ends_word(length)))
        --length;
      return first.substr(0, length);
    }
  } // namespace

  std::vector<std::pair<unsigned int, unsigned int>> tied_links(const Mesh &mesh)
  {
    std::vector<std::pair<unsigned int, unsigned int>> links;
    for (const TiedPair &pair : mesh.tied)
      {
        std::optional<unsigned int> first;
        for (const Mesh::Face &face : mesh.faces)
          if (const std::string &surface = mesh.surface_names[face.surface]; surface == pair.slave || surface == pair.master)
            {
              first = first.value_or(face.nodes[0]);
              links.emplace_back(*first, face.nodes[0]);
            }
      }
    return links;
  }

  void find_bodies(Mesh &mesh)
  {
    // Join volumes that share nodes, are tied, or belong to the disc
    const std::vector<std::string>     &names = mesh.volume_names;
    boost::disjoint_sets_with_storage<> sets(names.size() + mesh.points.size());
    for (const Mesh::Cell &cell : mesh.cells)
      for (const unsigned int node : cell.nodes)
        sets.union_set<std::size_t>(cell.volume, names.size() + node);
    for (const auto &[node, other] : tied_links(mesh))
      sets.union_set<std::size_t>(names.size() + node, names.size() + other);
    const auto first_of_disc = std::find_if(names.begin(), names.end(), is_of_disc) - names.begin();
    for (std::size_t volume = 0; volume < names.size(); ++volume)
      if (is_of_disc(names[volume]))
        sets.union_set<std::size_t>(volume, first_of_disc);

    std::map<std::size_t, unsigned int>    body_of_root;
    std::vector<std::vector<unsigned int>> volumes_of_bodies;
    const auto                             add = [&](const std::size_t volume) {
      const auto [found, is_new] = body_of_root.emplace(sets.find_set(volume), volumes_of_bodies.size());
      if (is_new)
        volumes_of_bodies.emplace_back();
      return found->second;
    };
    if (first_of_disc < static_cast<std::ptrdiff_t>(names.size()))
      add(first_of_disc);
    mesh.body_of_volume.clear();
    for (std::size_t volume = 0; volume < names.size(); ++volume)
      {
        mesh.body_of_volume.push_back(add(volume));
        volumes_of_bodies[mesh.body_of_volume.back()].push_back(volume);
      }

    mesh.body_names.clear();
    for (const std::vector<unsigned int> &volumes : volumes_of_bodies)
      {
        std::vector<std::string> own, others = mesh.body_names;
        bool                     has_disc = false;
        for (std::size_t volume = 0; volume < names.size(); ++volume)
          {
            const bool is_own = std::count(volumes.begin(), volumes.end(), volume) > 0;
            (is_own ? own : others).push_back(names[volume]);
            has_disc = has_disc || (is_own && is_of_disc(names[volume]));
          }
        const std::string common  = common_words(own);
        const bool        is_free = !common.empty() && std::count(others.begin(), others.end(), common) == 0;
        mesh.body_names.push_back(has_disc ? PhysicalNames::disc : is_free ? common : own[0]);
      }
  }

  std::vector<unsigned int> body_of_nodes(const Mesh &mesh)
  {
    std::vector<unsigned int> bodies(mesh.points.size(), 0);
    for (const Mesh::Cell &cell : mesh.cells)
      for (const unsigned int node : cell.nodes)
        bodies[node] = mesh.body_of(cell);
    return bodies;
  }

  unsigned int pin_number(const std::vector<std::string> &body_names, const std::string &pin, const char *parameter)
  {
    const std::vector<std::string> pins(body_names.begin() + 1, body_names.end());
    const auto                     found = std::find(pins.begin(), pins.end(), pin);
    if (found == pins.end())
      throw ParameterError("there is no pin `" + pin + "`", std::string("parameter ") + parameter,
                           "use one of " + boost::algorithm::join(pins, ", "));
    return found - pins.begin() + 1;
  }

  // ------------------------------------------------------------------- faces

  namespace
  {
    std::array<unsigned int, 4> key_of(std::array<unsigned int, 4> corners, const unsigned int n_corners)
    {
      if (n_corners == 3)
        corners[3] = std::max({corners[0], corners[1], corners[2]});
      std::sort(corners.begin(), corners.end());
      return corners;
    }

    template <typename Nodes>
    FaceGeometry geometry_of(const Mesh &mesh, const Nodes &nodes, const unsigned int n_corners)
    {
      const Mesh::Point &a = mesh.points[nodes[0]], &b = mesh.points[nodes[1]], &c = mesh.points[nodes[2]],
                        &d = mesh.points[nodes[n_corners - 1]];
      return {n_corners == 4 ? Mesh::Point((a + b + c + d) / 4.) : Mesh::Point((a + b + c) / 3.), cross_product_3d(c - a, d - b) / 2.};
    }
  } // namespace

  std::array<unsigned int, 4> face_key(const Mesh::Face &face)
  {
    const unsigned int          n_corners = topology(face.shape).corners.size();
    std::array<unsigned int, 4> corners   = {};
    std::copy_n(face.nodes.begin(), n_corners, corners.begin());
    return key_of(corners, n_corners);
  }

  CellFace face_of_cell(const Mesh &mesh, const std::size_t cell, const unsigned int number)
  {
    const Mesh::Cell &of      = mesh.cells[cell];
    const auto       &corners = topology(of.shape).faces[number];
    CellFace          face{cell, number, mesh.body_of(of), static_cast<unsigned int>(corners.size()), {}, {}};
    for (unsigned int i = 0; i < 4; ++i)
      face.corners[i] = of.nodes[corners[std::min<std::size_t>(i, corners.size() - 1)]];
    face.key = key_of(face.corners, face.n_corners);
    return face;
  }

  std::vector<CellFace> all_faces(const Mesh &mesh)
  {
    std::vector<CellFace> faces;
    faces.reserve(6 * mesh.cells.size());
    for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
      for (unsigned int f = 0; f < topology(mesh.cells[cell].shape).faces.size(); ++f)
        faces.push_back(face_of_cell(mesh, cell, f));
    std::sort(faces.begin(), faces.end(), [](const CellFace &a, const CellFace &b) { return a.key < b.key; });
    return faces;
  }

  std::vector<CellFace> outer_faces(const Mesh &mesh)
  {
    const std::vector<CellFace> all = all_faces(mesh);
    std::vector<CellFace>       outer;
    for (std::size_t i = 0; i < all.size(); ++i)
      if ((i == 0 || all[i - 1].key != all[i].key) && (i + 1 == all.size() || all[i + 1].key != all[i].key))
        outer.push_back(all[i]);
    return outer;
  }

  FaceGeometry face_geometry(const Mesh &mesh, const CellFace &face)
  {
    return geometry_of(mesh, face.corners, face.n_corners);
  }

  FaceGeometry face_geometry(const Mesh &mesh, const Mesh::Face &face)
  {
    return geometry_of(mesh, face.nodes, topology(face.shape).corners.size());
  }

  // ------------------------------------------------------ positions in cells

  namespace
  {
    using Tensor = dealii::Tensor<1, 3>;

    /// Depth below a face in reference coordinates, offset + gradient · ξ: 0 on the face, 1 at the most distant corner.
    struct FaceDepth
    {
      double offset;
      Tensor gradient;

      double at(const Mesh::Point &xi) const
      {
        return offset + gradient * Tensor(xi);
      }
    };

    const std::vector<FaceDepth> &depths_below_faces(const Shape shape)
    {
      static const auto all = [] {
        std::array<std::vector<FaceDepth>, 6> result;
        for (const Shape solid : {Shape::tetrahedron, Shape::pyramid, Shape::wedge, Shape::hexahedron})
          for (const auto &face : topology(solid).faces)
            {
              const auto  &corners = topology(solid).corners;
              const Tensor inwards = cross_product_3d(corners[face[2]] - corners[face[0]], corners[face[1]] - corners[face[0]]);
              double       extent  = 0.;
              for (const Mesh::Point &corner : corners)
                extent = std::max(extent, inwards * (corner - corners[face[0]]));
              result[static_cast<unsigned int>(solid)].push_back({-(inwards * Tensor(corners[face[0]])) / extent, inwards / extent});
            }
        return result;
      }();
      return all[static_cast<unsigned int>(shape)];
    }

    /// Depth below the nearest face; negative outside.
    double least_depth(const Shape shape, const Mesh::Point &xi)
    {
      double least = 1.;
      for (const FaceDepth &face : depths_below_faces(shape))
        least = std::min(least, face.at(xi));
      return least;
    }

    Mesh::Point reference_centre(const Shape shape)
    {
      Mesh::Point sum;
      for (const Mesh::Point &corner : topology(shape).corners)
        sum += corner / double(topology(shape).corners.size());
      return sum;
    }

    /// Isoparametric map x(ξ) and its derivatives.
    std::pair<Tensor, dealii::Tensor<2, 3>> mapped(const ShapeFunctions           &functions,
                                                   const std::vector<Mesh::Point> &nodes,
                                                   const Mesh::Point              &xi)
    {
      std::pair<Tensor, dealii::Tensor<2, 3>> result;
      for (unsigned int i = 0; i < functions.n(); ++i)
        {
          result.first += functions.value(i, xi) * Tensor(nodes[i]);
          result.second += outer_product(Tensor(nodes[i]), functions.gradient(i, xi));
        }
      return result;
    }

    /// A point of the reference cell that is approximately closest to ξ, found by projection onto each violated face in turn.
    Mesh::Point moved_inside(const Shape shape, Mesh::Point xi)
    {
      constexpr unsigned int n_rounds = 8; // one round is enough for faces at right angles
      for (unsigned int round = 0; round < n_rounds; ++round)
        for (const FaceDepth &face : depths_below_faces(shape))
          if (const double depth = face.at(xi); depth < 0.)
            xi -= depth / face.gradient.norm_square() * face.gradient;
      return xi;
    }
  } // namespace

  std::optional<Mesh::Point> reference_coordinates(const Shape                     shape,
                                                   const unsigned int              degree,
                                                   const std::vector<Mesh::Point> &nodes,
                                                   const Mesh::Point              &point)
  {
    constexpr int         max_steps  = 20;
    constexpr double      negligible = 5e-9, far = 0.75; // far is below 1, the distance of neighbouring nodes of a regular grid
    const ShapeFunctions &functions = ShapeFunctions::of(shape, degree);
    Mesh::Point           xi        = reference_centre(shape);
    for (int step = 0; step <= max_steps && least_depth(shape, xi) > -far; ++step)
      {
        const auto [x, jacobian] = mapped(functions, nodes, xi);
        const Tensor change      = invert(jacobian) * (Tensor(point) - x);
        xi += change;
        if (std::max({std::abs(change[0]), std::abs(change[1]), std::abs(change[2])}) < negligible)
          return xi;
      }
    return {};
  }

  Mesh::Point centre(const Mesh &mesh, const Mesh::Cell &cell)
  {
    const unsigned int n_corners = topology(cell.shape).corners.size();
    Mesh::Point        sum;
    for (unsigned int v = 0; v < n_corners; ++v)
      sum += mesh.corner(cell, v) / double(n_corners);
    return sum;
  }

  std::optional<Depth> depth_in_cell(const Mesh &mesh, const Mesh::Cell &cell, const Mesh::Point &point)
  {
    std::vector<Mesh::Point> corners;
    for (unsigned int v = 0; v < topology(cell.shape).corners.size(); ++v)
      corners.push_back(mesh.corner(cell, v));
    const auto xi = reference_coordinates(cell.shape, 1, corners, point);
    if (!xi)
      return {};
    // Outside the cell, where the map may be singular, use an approximately nearest point of the cell
    const ShapeFunctions &functions = ShapeFunctions::of(cell.shape, 1);
    Depth                 depth{least_depth(cell.shape, *xi), std::numeric_limits<double>::infinity()};
    if (depth.relative < 0.)
      depth.length = -(Tensor(point) - mapped(functions, corners, moved_inside(cell.shape, *xi)).first).norm();
    else
      {
        const auto inverse = transpose(invert(mapped(functions, corners, *xi).second));
        for (const FaceDepth &face : depths_below_faces(cell.shape))
          depth.length = std::min(depth.length, face.at(*xi) / (inverse * face.gradient).norm());
      }
    return depth;
  }
} // namespace Squeal
