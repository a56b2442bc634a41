// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/surface_overlap.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Smallest overlap relative to the slave area and to the area of an element, and smallest D_j relative to ∫ Ñ_j [-].
    constexpr double least_overlap = 1e-3, least_of_element = 0.02, least_of_node = 0.1;

    /// Smaller weights are rounding errors [-].
    constexpr double least_weight = 1e-13;

    /// Largest mean cosine between the normals of opposite surfaces [-].
    constexpr double largest_cosine = -0.5;

    /// Largest admissible gap and largest gap without a note, relative to the mean size of the slave faces [-]. Chords of curved
    /// faces usually cause smaller gaps than the second limit.
    constexpr double touching_gap = 0.5, noted_gap = 0.05;

    /// Ratio of slave to master face sizes above which the slave pressure oscillates [-].
    constexpr double noted_coarseness = 3.;

    unsigned int n_corners(const SurfaceElement &element)
    {
      return element.shape == Shape::triangle ? 3 : 4;
    }

    /// Transformation from N to Ñ, see mortar(); α = 0 without 6-node triangles.
    class Transformation
    {
    public:
      explicit Transformation(const SurfacePatch &slave)
      {
        for (unsigned int j = 0; j < slave.points.size(); ++j)
          {
            values.push_back({{j, 1.}});
            forces.push_back({{j, 1.}});
          }
        for (const SurfaceElement &element : slave.elements)
          if (element.nodes.size() == 6)
            alpha = 0.2;
        if (alpha > 0.)
          for (const SurfaceElement &element : slave.elements)
            for (unsigned int i = 0; i < n_corners(element); ++i)
              add_edge(element.nodes[n_corners(element) + i], element.nodes[i], element.nodes[(i + 1) % n_corners(element)]);
      }

      /// Matrix T of Ñ = T N on an element.
      FaceMatrix of(const SurfaceElement &element) const
      {
        FaceMatrix         result = FaceMatrix::Identity();
        const unsigned int n      = n_corners(element);
        if (alpha > 0.)
          for (unsigned int i = 0; i < n; ++i)
            {
              result(n + i, n + i) = 1. - 2. * alpha;
              result(i, n + i) = result((i + 1) % n, n + i) = alpha;
            }
        return result;
      }

      std::vector<NodeWeights> values; ///< ũ_j in terms of u
      std::vector<NodeWeights> forces; ///< forces that act on ũ_j in terms of forces that act on u

    private:
      void add_edge(const unsigned int e, const unsigned int v, const unsigned int w)
      {
        if (values[e].size() > 1)
          return; // the edge was added with the neighbouring element
        values[e] = {{e, 1. / (1. - 2. * alpha)}, {v, -alpha / (1. - 2. * alpha)}, {w, -alpha / (1. - 2. * alpha)}};
        forces[e] = {{e, 1. - 2. * alpha}};
        forces[v].emplace_back(e, alpha);
        forces[w].emplace_back(e, alpha);
      }

      double alpha = 0.;
    };

    /// A slave node with the sums over its elements.
    struct SlaveNode
    {
      double                         whole = 0.; ///< ∫ Ñ_j over the elements
      double                         area  = 0.; ///< ∫ Ñ_j over the overlap
      std::map<unsigned int, double> master;     ///< ∫ ψ_j N_l
      std::set<unsigned int>         neighbours; ///< nodes of the same overlapping elements
    };

    /// Adds the dual functions of an element; does nothing if the overlap is too small for linearly independent shape functions.
    void add_element(std::vector<SlaveNode> &nodes,
                     const SurfaceElement   &element,
                     const FaceMatrix       &transformation,
                     const ElementOverlap   &overlap,
                     const SurfacePatch     &master)
    {
      const int                         n    = element.nodes.size();
      const Eigen::MatrixXd             mass = (transformation * overlap.mass * transformation.transpose()).topLeftCorner(n, n);
      const Eigen::VectorXd             area = mass.rowwise().sum();
      const Eigen::LLT<Eigen::MatrixXd> factor(mass);
      if (factor.info() != Eigen::Success)
        return;
      for (int j = 0; j < n; ++j)
        {
          nodes[element.nodes[j]].area += area[j];
          nodes[element.nodes[j]].neighbours.insert(element.nodes.begin(), element.nodes.end());
        }
      for (const auto &[number, coupling] : overlap.coupling)
        {
          const auto           &others = master.elements[number].nodes;
          const Eigen::MatrixXd dual   = area.asDiagonal() * factor.solve((transformation * coupling).topLeftCorner(n, others.size()));
          for (int j = 0; j < n; ++j)
            for (unsigned int l = 0; l < others.size(); ++l)
              nodes[element.nodes[j]].master[others[l]] += dual(j, l);
        }
    }

    /// Slave nodes of each mortar row, by the node of the row: nodes with little overlap are merged with the neighbour that has the
    /// largest area.
    std::map<unsigned int, std::vector<unsigned int>> grouped(const std::vector<SlaveNode> &nodes)
    {
      std::map<unsigned int, std::vector<unsigned int>> groups;
      std::vector<unsigned int>                         row(nodes.size());
      std::vector<double>                               area(nodes.size());
      for (unsigned int j = 0; j < nodes.size(); ++j)
        {
          row[j]    = j;
          area[j]   = nodes[j].area;
          groups[j] = {j};
        }
      // Repeat until nothing changes, because adding a negative area may make a sum too small
      for (bool is_changed = true; is_changed;)
        {
          is_changed = false;
          for (unsigned int j = 0; j < nodes.size(); ++j)
            if (row[j] == j && !(area[j] > least_of_node * nodes[j].whole))
              {
                unsigned int largest = j;
                for (const unsigned int other : nodes[j].neighbours)
                  if (row[other] != j && (largest == j || area[row[other]] > area[largest]))
                    largest = row[other];
                if (largest == j)
                  continue;
                for (const unsigned int i : groups[j])
                  row[i] = largest;
                groups[largest].insert(groups[largest].end(), groups[j].begin(), groups[j].end());
                area[largest] += area[j];
                groups.erase(j);
                is_changed = true;
              }
        }
      for (unsigned int j = 0; j < nodes.size(); ++j)
        if (!(area[j] > least_of_node * nodes[j].whole))
          groups.erase(j);
      return groups;
    }

    NodeWeights listed(const std::map<unsigned int, double> &weights)
    {
      NodeWeights result;
      for (const auto &[node, weight] : weights)
        if (std::abs(weight) > least_weight)
          result.emplace_back(node, weight);
      return result;
    }

    MortarRow make_row(const unsigned int               node,
                       const std::vector<unsigned int> &group,
                       const std::vector<SlaveNode>    &nodes,
                       const Transformation            &transformation)
    {
      MortarRow row{node, 0., {}, {}, {}};
      for (const unsigned int j : group)
        row.area += nodes[j].area;
      std::map<unsigned int, double> slave, master, left_inverse;
      for (const unsigned int j : group)
        {
          for (const auto &[i, weight] : transformation.values[j])
            slave[i] += weight * (nodes[j].area / row.area);
          for (const auto &[l, integral] : nodes[j].master)
            master[l] += integral / row.area;
          for (const auto &[i, weight] : transformation.forces[j])
            left_inverse[i] += weight;
        }
      row.slave        = listed(slave);
      row.master       = listed(master);
      row.left_inverse = listed(left_inverse);
      double sum       = 0.;
      for (const auto &[l, weight] : row.master)
        sum += weight;
      for (auto &[l, weight] : row.master)
        weight /= sum;
      return row;
    }

    void check(const Mortar &mortar, const double mean_cosine, const double search_distance)
    {
      const char *where = "surfaces disc_contact and pin_contact";
      if (mean_cosine > largest_cosine)
        throw MeshError(text("the surfaces do not face each other: the mean cosine between their outward normals is ", mean_cosine,
                             ", but at most ", largest_cosine, " is allowed"),
                        where, "name the two surfaces at which the bodies touch, and move the bodies to opposite sides of the contact");
      if (!(mortar.overlap_area >= least_overlap * mortar.slave_area) || mortar.rows.empty())
        throw MeshError(text("the surfaces overlap by ", mortar.overlap_area, " m² of ", mortar.slave_area, " m²"), where,
                        text("move them opposite each other, with a gap below ", search_distance, " m, or name other surfaces"));
    }
  } // namespace

  Mortar mortar(const SurfacePatch &slave, const SurfacePatch &master, const double search_distance)
  {
    const SurfaceOverlap   overlaps = overlap(slave, master, search_distance);
    const Transformation   transformation(slave);
    std::vector<SlaveNode> nodes(slave.points.size());
    Mortar                 result{{}, 0., 0., overlaps.coarseness, overlaps.largest_gap};
    for (unsigned int e = 0; e < slave.elements.size(); ++e)
      {
        const SurfaceElement &element = slave.elements[e];
        const FaceMatrix      t       = transformation.of(element);
        const FaceVector      areas   = t * whole_element(slave, element).functions;
        for (unsigned int j = 0; j < element.nodes.size(); ++j)
          nodes[element.nodes[j]].whole += areas[j];
        const double area = overlaps.elements[e].area();
        result.slave_area += areas.sum();
        result.overlap_area += area;
        if (area > least_of_element * areas.sum())
          add_element(nodes, element, t, overlaps.elements[e], master);
      }
    for (const auto &[node, group] : grouped(nodes))
      result.rows.push_back(make_row(node, group, nodes, transformation));
    check(result, overlaps.mean_cosine, search_distance);
    return result;
  }

  double largest_gap(const SurfacePatch &slave)
  {
    double area = 0.;
    for (const SurfaceElement &element : slave.elements)
      area += whole_element(slave, element).functions.sum();
    return touching_gap * std::sqrt(area / slave.elements.size());
  }

  std::vector<std::string> coupling_notes(const Mortar      &coupling,
                                          const double       largest_gap,
                                          const std::string &slave,
                                          const std::string &master)
  {
    std::vector<std::string> notes = {text("coupled by mortar elements over ",
                                           std::round(1000. * coupling.overlap_area / coupling.slave_area) / 10., " % of ",
                                           coupling.slave_area, " m^2")};
    if (coupling.largest_gap > noted_gap / touching_gap * largest_gap)
      notes.push_back(text("gaps or penetrations of up to ", coupling.largest_gap, " m: the faces are coupled as if they touched"));
    if (coupling.coarseness > noted_coarseness)
      notes.push_back(text("faces of ", slave, " are up to ", coupling.coarseness, " times as large as the opposite faces of ", master,
                           ": the coarser side limits the resolution of the pressure"));
    return notes;
  }
} // namespace Squeal
