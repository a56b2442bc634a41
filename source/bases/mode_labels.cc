#include <squeal/base/decision.h>
#include <squeal/bases/mode_labels.h>
#include <squeal/linear_algebra/orthonormal_basis.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <limits>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Functions r^k e^{inθ} of a disc's plane that the others do not span.
    const Decision independent("rest of a function of a label / function", 1e-8);

    /// Least-squares projection of nodal fields on a few functions in the mass-weighted inner product.
    class Projection
    {
    public:
      /**
       * @param functions  n_nodes × n_functions
       * @param weights    n_nodes
       */
      Projection(const DenseMatrix &functions, const std::vector<double> &weights)
        : roots(as_column(weights).cwiseSqrt())
        // Functions that others span (r^k on a single radius) are dropped
        , basis(
            orthonormal_basis(DenseMatrix(roots.asDiagonal() * functions), [](const double rest) { return independent.exceeded_by(rest); }))
      {
        for (auto &diagonal : basis.R.diagonal())
          diagonal = diagonal > 0. ? diagonal : 1.;
      }

      /// Energy of the projection of a field: the sum of its squared orthonormal coefficients.
      double energy(const std::vector<double> &field) const
      {
        return orthonormal_coefficients(field).squaredNorm();
      }

      /// Factors of the functions in the projection of a field.
      Eigen::VectorXd coefficients(const std::vector<double> &field) const
      {
        return basis.R.triangularView<Eigen::Upper>().solve(orthonormal_coefficients(field));
      }

    private:
      Eigen::VectorXd orthonormal_coefficients(const std::vector<double> &field) const
      {
        return basis.Q.transpose() * roots.cwiseProduct(as_column(field));
      }

      Eigen::VectorXd               roots; ///< of the weights
      OrthonormalBasis<DenseMatrix> basis; ///< of the functions times the roots; dropped ones have ones on the diagonal of R
    };

    /// Displacement of a node; clamped directions are at rest.
    std::array<double, 3> displacement(const Node &node, const double *mode)
    {
      std::array<double, 3> u;
      for (unsigned int k = 0; k < 3; ++k)
        u[k] = node.dofs[k] >= 0 ? mode[node.dofs[k]] : 0.;
      return u;
    }

    constexpr int n_radial_functions = 5;
    constexpr int largest_harmonic   = 16;

    /// Projections of disc fields on harmonics 0 ... largest_harmonic.
    struct DiscHarmonics
    {
      std::vector<const Node *> nodes;
      std::vector<double>       weights, cosines, sines;
      double                    inner_radius, outer_radius;
      std::vector<Projection>   harmonics;

      DiscHarmonics(const Model &model, const std::vector<double> &nodal_masses)
      {
        inner_radius = std::numeric_limits<double>::max();
        outer_radius = 0.;
        std::vector<double> radii;
        for (std::size_t i = 0; i < model.nodes().size(); ++i)
          if (const Node &node = model.nodes()[i]; node.component == 0)
            {
              const double r = std::hypot(node.position[0], node.position[1]);
              nodes.push_back(&node);
              weights.push_back(nodal_masses[i]);
              radii.push_back(r);
              cosines.push_back(r > 0. ? node.position[0] / r : 1.);
              sines.push_back(r > 0. ? node.position[1] / r : 0.);
              inner_radius = std::min(inner_radius, r);
              outer_radius = std::max(outer_radius, r);
            }
        for (int n = 0; n <= largest_harmonic; ++n)
          {
            // Columns: powers of the scaled radius times cosine, then times sine
            DenseMatrix functions(nodes.size(), (n == 0 ? 1 : 2) * n_radial_functions);
            for (std::size_t i = 0; i < nodes.size(); ++i)
              {
                const double s = scaled_radius(radii[i]), theta = std::atan2(sines[i], cosines[i]);
                for (int k = 0; k < n_radial_functions; ++k)
                  {
                    functions(i, k) = std::pow(s, k) * std::cos(n * theta);
                    if (n > 0)
                      functions(i, n_radial_functions + k) = std::pow(s, k) * std::sin(n * theta);
                  }
              }
            harmonics.emplace_back(std::move(functions), weights);
          }
      }

      double scaled_radius(const double r) const
      {
        return (2. * r - inner_radius - outer_radius) / (outer_radius - inner_radius);
      }

      /// Axial, radial and circumferential displacement of the nodes.
      std::array<std::vector<double>, 3> cylindrical(const double *mode) const
      {
        std::array<std::vector<double>, 3> fields;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          {
            const auto u = displacement(*nodes[i], mode);
            fields[0].push_back(u[2]);
            fields[1].push_back(u[0] * cosines[i] + u[1] * sines[i]);
            fields[2].push_back(-u[0] * sines[i] + u[1] * cosines[i]);
          }
        return fields;
      }

      /**
       * Sign changes of the radial profile of harmonic n. The projection is
       * sampled in narrow rings: in each, its cosine and sine amplitude; the
       * nodal line pattern may be turned, so the amplitudes are taken along
       * their common direction in the cosine-sine plane.
       */
      int nodal_circles(const std::vector<double> &field, const int n) const
      {
        // Profile a(r) cos nθ + b(r) sin nθ
        constexpr int n_samples = 41;
        const auto    profile   = radial_profile(field, n, n_samples);

        // Common direction: dominant axis of Σ (a, b)ᵀ(a, b)
        double aa = 0., ab = 0., bb = 0.;
        for (const auto &[a, b] : profile)
          {
            aa += a * a;
            ab += a * b;
            bb += b * b;
          }
        const double        angle   = 0.5 * std::atan2(2. * ab, aa - bb);
        double              largest = 0.;
        std::vector<double> amplitude;
        for (const auto &[a, b] : profile)
          {
            amplitude.push_back(a * std::cos(angle) + b * std::sin(angle));
            largest = std::max(largest, std::abs(amplitude.back()));
          }

        // Changes between values that are clearly different from zero
        constexpr double clear = 0.1;
        int              sign = 0, changes = 0;
        for (const double value : amplitude)
          if (std::abs(value) > clear * largest)
            {
              const int new_sign = value > 0. ? 1 : -1;
              changes += sign != 0 && new_sign != sign;
              sign = new_sign;
            }
        return changes;
      }

    private:
      /// (a, b) at equidistant radii of the projection Σ_k s^k (a_k cos nθ + b_k sin nθ).
      std::vector<std::pair<double, double>> radial_profile(const std::vector<double> &field, const int n, const int n_samples) const
      {
        const auto                             factors = harmonics[n].coefficients(field);
        std::vector<std::pair<double, double>> profile;
        for (int i = 0; i < n_samples; ++i)
          {
            const double s = -1. + 2. * i / (n_samples - 1);
            double       a = 0., b = 0.;
            for (int k = 0; k < n_radial_functions; ++k)
              {
                a += factors[k] * std::pow(s, k);
                if (n > 0)
                  b += factors[n_radial_functions + k] * std::pow(s, k);
              }
            profile.emplace_back(a, b);
          }
        return profile;
      }
    };
  } // namespace

  std::vector<ModeLabel> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const DenseMatrix &modes)
  {
    constexpr std::array<ModeFamily, 3> families = {{ModeFamily::axial, ModeFamily::radial, ModeFamily::circumferential}};
    const DiscHarmonics                 disc(model, nodal_masses);
    std::vector<ModeLabel>              labels;
    for (int j = 0; j < modes.cols(); ++j)
      {
        const auto fields = disc.cylindrical(modes.col(j).data());

        // Harmonic of the largest energy, the three directions together
        double                largest = -1.;
        int                   n_best  = 0;
        std::array<double, 3> energies{};
        for (int n = 0; n <= largest_harmonic; ++n)
          {
            std::array<double, 3> e;
            for (unsigned int d = 0; d < 3; ++d)
              e[d] = disc.harmonics[n].energy(fields[d]);
            if (const double sum = e[0] + e[1] + e[2]; sum > largest)
              {
                largest  = sum;
                n_best   = n;
                energies = e;
              }
          }

        const unsigned int family = std::max_element(energies.begin(), energies.end()) - energies.begin();
        labels.push_back({families[family], disc.nodal_circles(fields[family], n_best), n_best});
      }
    return labels;
  }

  namespace
  {
    using Vector = dealii::Tensor<1, 3>;

    Vector vector(const std::array<double, 3> &components)
    {
      return Vector({components[0], components[1], components[2]});
    }

    /// A pin with its axis, through the centre of its contact nodes along their mean normal.
    struct Pin
    {
      Vector                    centre, axis;
      double                    n_contact = 0.;
      std::vector<const Node *> nodes;
      std::vector<double>       weights; ///< masses of the nodes [kg]

      Vector from_centre(const Node &node) const
      {
        return vector(node.position) - centre;
      }

      /// The part of a vector across the axis.
      Vector across(const Vector &v) const
      {
        return v - (v * axis) * axis;
      }
    };

    std::map<unsigned int, Pin> pins_of(const Model &model, const ContactInterface &interface, const std::vector<double> &nodal_masses)
    {
      std::map<unsigned int, Pin> pins;
      for (const ContactNode &contact : interface)
        {
          Pin &pin = pins[contact.pin];
          pin.n_contact += 1.;
          pin.centre += vector(contact.position);
          pin.axis += vector(contact.normal);
        }
      for (auto &[number, pin] : pins)
        {
          pin.centre /= pin.n_contact;
          pin.axis /= pin.axis.norm();
        }
      for (std::size_t i = 0; i < model.nodes().size(); ++i)
        if (const auto pin = pins.find(model.nodes()[i].component); pin != pins.end())
          {
            pin->second.nodes.push_back(&model.nodes()[i]);
            pin->second.weights.push_back(nodal_masses[i]);
          }
      return pins;
    }

    /// Adds the energies of bending, torsion and stretching of each mode: of its projections on polynomials of the height.
    void add_energies(const Pin &pin, const DenseMatrix &modes, std::vector<std::array<double, 3>> &energies)
    {
      constexpr int     n_height_functions = 4;
      const std::size_t n                  = pin.nodes.size();
      double            height             = 0.;
      for (const Node *node : pin.nodes)
        height = std::max(height, std::abs(pin.from_centre(*node) * pin.axis));
      DenseMatrix powers(n, n_height_functions), radius_powers(n, n_height_functions);
      for (std::size_t i = 0; i < n; ++i)
        for (int p = 0; p < n_height_functions; ++p)
          {
            const Vector d      = pin.from_centre(*pin.nodes[i]);
            powers(i, p)        = std::pow(d * pin.axis / height, p);
            radius_powers(i, p) = pin.across(d).norm() * powers(i, p);
          }
      const Projection translation(powers, pin.weights), torsion(radius_powers, pin.weights);

      std::vector<double> u_axial(n), u_turning(n), u_across[3] = {u_axial, u_axial, u_axial};
      for (int m = 0; m < modes.cols(); ++m)
        {
          for (std::size_t i = 0; i < n; ++i)
            {
              const Vector u = vector(displacement(*pin.nodes[i], modes.col(m).data())), d = pin.across(pin.from_centre(*pin.nodes[i]));
              u_axial[i]   = u * pin.axis;
              u_turning[i] = d.norm() > 0. ? dealii::cross_product_3d(d, u) * pin.axis / d.norm() : 0.;
              for (unsigned int k = 0; k < 3; ++k)
                u_across[k][i] = pin.across(u)[k];
            }
          for (const auto &component : u_across)
            energies[m][0] += translation.energy(component);
          energies[m][1] += torsion.energy(u_turning);
          energies[m][2] += translation.energy(u_axial);
        }
    }
  } // namespace

  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const DenseMatrix         &modes)
  {
    const auto                         pins = pins_of(model, interface, nodal_masses);
    std::vector<std::array<double, 3>> energies(modes.cols(), std::array<double, 3>{});
    for (const auto &[number, pin] : pins)
      add_energies(pin, modes, energies);

    // Numbers within each family, by the number of modes that every pin has of it
    constexpr std::array<ModeFamily, 3> families = {{ModeFamily::flexural, ModeFamily::torsional, ModeFamily::longitudinal}};
    std::vector<ModeLabel>              labels;
    std::array<int, 3>                  count{};
    const int                           n_pins    = pins.size();
    const std::array<int, 3>            per_order = {{2 * n_pins, n_pins, n_pins}};
    for (const auto &e : energies)
      {
        const unsigned int f = std::max_element(e.begin(), e.end()) - e.begin();
        labels.push_back({families[f], 0, 0, count[f]++ / per_order[f] + 1});
      }
    return labels;
  }
} // namespace Squeal
