#include <squeal/base/decision.h>
#include <squeal/bases/mode_labels.h>
#include <squeal/linear_algebra/orthonormal_basis.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

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
      Projection(const DenseMatrix &functions, const Eigen::VectorXd &weights)
        : roots(weights.cwiseSqrt())
        // Functions that others span (r^k on a single radius) are dropped
        , basis(
            orthonormal_basis(DenseMatrix(roots.asDiagonal() * functions), [](const double rest) { return independent.exceeded_by(rest); }))
      {
        for (auto &diagonal : basis.R.diagonal())
          diagonal = diagonal > 0. ? diagonal : 1.;
      }

      /// Energy of the projection of each field, n_nodes × k: the sum of its squared orthonormal coefficients.
      Eigen::VectorXd energies(const DenseMatrix &fields) const
      {
        return orthonormal_coefficients(fields).colwise().squaredNorm();
      }

      /// Factors of the functions in the projection of a field.
      Eigen::VectorXd coefficients(const DenseMatrix &field) const
      {
        return basis.R.triangularView<Eigen::Upper>().solve(orthonormal_coefficients(field));
      }

    private:
      DenseMatrix orthonormal_coefficients(const DenseMatrix &fields) const
      {
        return basis.Q.transpose() * (roots.asDiagonal() * fields);
      }

      Eigen::VectorXd               roots; ///< of the weights
      OrthonormalBasis<DenseMatrix> basis; ///< of the functions times the roots; dropped ones have ones on the diagonal of R
    };

    /// 1, x, x², ... as columns.
    DenseMatrix powers(const Eigen::VectorXd &x, const int n_powers)
    {
      DenseMatrix result = DenseMatrix::Ones(x.size(), n_powers);
      for (int k = 1; k < n_powers; ++k)
        result.col(k) = result.col(k - 1).cwiseProduct(x);
      return result;
    }

    /// Nodes of one component.
    struct Nodes
    {
      std::vector<const Node *> nodes;
      Eigen::MatrixX3d          positions; ///< [m]
      Eigen::VectorXd           masses;    ///< [kg]

      Nodes(const Model &model, const std::vector<double> &nodal_masses, const unsigned int component)
      {
        std::vector<double> chosen;
        for (std::size_t i = 0; i < nodal_masses.size(); ++i)
          if (model.nodes()[i].component == component)
            {
              nodes.push_back(&model.nodes()[i]);
              chosen.push_back(nodal_masses[i]);
            }
        masses = as_column(chosen);
        positions.resize(nodes.size(), 3);
        for (std::size_t i = 0; i < nodes.size(); ++i)
          positions.row(i) = Eigen::RowVector3d::Map(nodes[i]->position.data());
      }

      /// Of a mode on all free dofs; clamped directions are at rest.
      Eigen::MatrixX3d displacements(const Eigen::VectorXd &mode) const
      {
        Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(nodes.size(), 3);
        for (std::size_t i = 0; i < nodes.size(); ++i)
          for (unsigned int k = 0; k < 3; ++k)
            if (nodes[i]->dofs[k] >= 0)
              u(i, k) = mode[nodes[i]->dofs[k]];
        return u;
      }
    };

    // -------------------------------------------------------------------- disc

    /// Families of disc modes in the order of the displacement components of DiscHarmonics::cylindrical().
    constexpr std::array<ModeFamily, 3> disc_families = {{ModeFamily::axial, ModeFamily::radial, ModeFamily::circumferential}};

    constexpr int n_radial_functions = 5;
    constexpr int largest_harmonic   = 16;

    /// Projections of disc fields on harmonics 0 ... largest_harmonic.
    struct DiscHarmonics
    {
      Nodes                   disc;
      Eigen::VectorXd         cosines, sines;
      DenseMatrix             radial; ///< powers of the radius, which is scaled to [-1, 1], at the nodes
      std::vector<Projection> harmonics;

      DiscHarmonics(const Model &model, const std::vector<double> &nodal_masses)
        : disc(model, nodal_masses, 0)
      {
        const Eigen::VectorXd radii = disc.positions.leftCols(2).rowwise().norm();
        const Eigen::VectorXd theta =
          disc.positions.col(1).binaryExpr(disc.positions.col(0), [](const double y, const double x) { return std::atan2(y, x); });
        cosines = theta.array().cos();
        sines   = theta.array().sin();

        // Columns: powers of the radius times cosine, then times sine
        const double inner = radii.minCoeff(), outer = radii.maxCoeff();
        radial = powers((2. * radii.array() - inner - outer) / (outer - inner), n_radial_functions);
        for (int n = 0; n <= largest_harmonic; ++n)
          {
            DenseMatrix functions(radii.size(), (n == 0 ? 1 : 2) * n_radial_functions);
            functions.leftCols(n_radial_functions) = (n * theta).array().cos().matrix().asDiagonal() * radial;
            if (n > 0)
              functions.rightCols(n_radial_functions) = (n * theta).array().sin().matrix().asDiagonal() * radial;
            harmonics.emplace_back(functions, disc.masses);
          }
      }

      /// Axial, radial and circumferential displacement of the nodes.
      Eigen::MatrixX3d cylindrical(const Eigen::VectorXd &mode) const
      {
        const Eigen::MatrixX3d u = disc.displacements(mode);
        Eigen::MatrixX3d       fields(u.rows(), 3);
        fields << u.col(2), cosines.cwiseProduct(u.col(0)) + sines.cwiseProduct(u.col(1)),
          cosines.cwiseProduct(u.col(1)) - sines.cwiseProduct(u.col(0));
        return fields;
      }

      /**
       * Sign changes of the radial profile of harmonic n. The projection is
       * sampled in narrow rings: in each, its cosine and sine amplitude; the
       * nodal line pattern may be turned, so the amplitudes are taken along
       * their common direction in the cosine-sine plane.
       */
      int nodal_circles(const Eigen::VectorXd &field, const int n) const
      {
        // Profile a(r) cos nθ + b(r) sin nθ
        constexpr int         n_samples = 41;
        const DenseMatrix     radial    = powers(Eigen::VectorXd::LinSpaced(n_samples, -1., 1.), n_radial_functions);
        const Eigen::VectorXd factors   = harmonics[n].coefficients(field);
        const Eigen::VectorXd a         = radial * factors.head(n_radial_functions);
        Eigen::VectorXd       b         = Eigen::VectorXd::Zero(n_samples);
        if (n > 0)
          b = radial * factors.tail(n_radial_functions);

        // Common direction: dominant axis of Σ (a, b)ᵀ(a, b)
        const double          angle     = 0.5 * std::atan2(2. * a.dot(b), a.squaredNorm() - b.squaredNorm());
        const Eigen::VectorXd amplitude = std::cos(angle) * a + std::sin(angle) * b;

        // Changes between values that are clearly different from zero
        constexpr double clear   = 0.1;
        const double     largest = max_norm(amplitude);
        int              changes = 0;
        double           last    = 0.;
        for (const double value : amplitude)
          if (std::abs(value) > clear * largest)
            {
              changes += last * value < 0.;
              last = value;
            }
        return changes;
      }

      /// How a field travels in harmonic n > 0; nothing where it has none of it.
      std::optional<WaveShares> wave_shares(const Eigen::VectorXd &real_part, const Eigen::VectorXd &imaginary_part, const int n) const
      {
        constexpr std::complex<double> i(0., 1.);
        const Eigen::VectorXcd         factors = harmonics[n].coefficients(real_part) + i * harmonics[n].coefficients(imaginary_part);
        const Eigen::VectorXcd         a = radial * factors.head(n_radial_functions), b = radial * factors.tail(n_radial_functions);
        const double positive = disc.masses.dot((a + i * b).cwiseAbs2()), negative = disc.masses.dot((a - i * b).cwiseAbs2());
        const double both = positive + negative;
        return both > 0. ? std::make_optional(WaveShares{positive / both, negative / both}) : std::nullopt;
      }
    };

    // -------------------------------------------------------------------- pins

    /// The axis of a pin, through the centre of its contact nodes along their mean normal.
    struct PinAxis
    {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
      int             n_contact = 0;
    };

    std::map<unsigned int, PinAxis> pin_axes(const ContactInterface &interface)
    {
      std::map<unsigned int, PinAxis> axes;
      for (const ContactNode &contact : interface)
        {
          PinAxis &axis = axes[contact.pin];
          axis.centre += contact.position;
          axis.direction += contact.normal;
          ++axis.n_contact;
        }
      for (auto &[pin, axis] : axes)
        {
          axis.centre /= axis.n_contact;
          axis.direction.normalize();
        }
      return axes;
    }

    /// Adds the energies of bending, torsion and stretching of each mode, 3 × k: of its projections on polynomials of the height.
    void add_energies(const Nodes &pin, const PinAxis &axis, const DenseMatrix &modes, DenseMatrix &energies)
    {
      constexpr int          n_height_functions = 4;
      const Eigen::Vector3d  along              = axis.direction;
      const Eigen::MatrixX3d places             = pin.positions.rowwise() - axis.centre.transpose();
      const Eigen::VectorXd  heights            = places * along;
      const Eigen::MatrixX3d arms               = places - heights * along.transpose();
      const Eigen::VectorXd  radii              = arms.rowwise().norm();
      Eigen::MatrixX3d       around             = arms.rowwise().cross(along); // unit vectors about the axis, zero on it
      for (Eigen::Index i = 0; i < radii.size(); ++i)
        around.row(i) /= radii[i] > 0. ? radii[i] : 1.;

      const DenseMatrix functions = powers(heights / max_norm(heights), n_height_functions);
      const Projection  translation(functions, pin.masses), torsion(radii.asDiagonal() * functions, pin.masses);
      for (Eigen::Index m = 0; m < modes.cols(); ++m)
        {
          const Eigen::MatrixX3d u       = pin.displacements(modes.col(m));
          const Eigen::VectorXd  axially = u * along;
          energies(0, m) += translation.energies(u - axially * along.transpose()).sum();
          energies(1, m) += torsion.energies(u.cwiseProduct(around).rowwise().sum()).sum();
          energies(2, m) += translation.energies(axially).sum();
        }
    }
  } // namespace

  std::vector<ModeLabel> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const DenseMatrix &modes)
  {
    const DiscHarmonics    disc(model, nodal_masses);
    std::vector<ModeLabel> labels;
    for (Eigen::Index j = 0; j < modes.cols(); ++j)
      {
        const Eigen::MatrixX3d fields = disc.cylindrical(modes.col(j));

        // Harmonic of the largest energy, the three directions together
        DenseMatrix energies(3, largest_harmonic + 1);
        for (int n = 0; n <= largest_harmonic; ++n)
          energies.col(n) = disc.harmonics[n].energies(fields);
        Eigen::Index diameters, family;
        energies.colwise().sum().maxCoeff(&diameters);
        energies.col(diameters).maxCoeff(&family);
        labels.push_back(
          {disc_families[family], disc.nodal_circles(fields.col(family), static_cast<int>(diameters)), static_cast<int>(diameters)});
      }
    return labels;
  }

  std::vector<std::optional<WaveShares>> wave_shares(const Model                  &model,
                                                     const std::vector<double>    &nodal_masses,
                                                     const std::vector<ModeLabel> &labels,
                                                     const DenseMatrix            &real_part,
                                                     const DenseMatrix            &imaginary_part)
  {
    const DiscHarmonics                    disc(model, nodal_masses);
    std::vector<std::optional<WaveShares>> shares(labels.size());
    for (std::size_t j = 0; j < labels.size(); ++j)
      for (std::size_t component = 0; component < disc_families.size(); ++component)
        if (labels[j].family == disc_families[component] && labels[j].nodal_diameters > 0)
          shares[j] = disc.wave_shares(disc.cylindrical(real_part.col(j)).col(component),
                                       disc.cylindrical(imaginary_part.col(j)).col(component), labels[j].nodal_diameters);
    return shares;
  }

  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const DenseMatrix         &modes)
  {
    const auto  axes     = pin_axes(interface);
    DenseMatrix energies = DenseMatrix::Zero(3, modes.cols());
    for (const auto &[pin, axis] : axes)
      add_energies(Nodes(model, nodal_masses, pin), axis, modes, energies);

    // Numbers within each family, by the number of modes that every pin has of it
    constexpr std::array<ModeFamily, 3> families = {{ModeFamily::flexural, ModeFamily::torsional, ModeFamily::longitudinal}};
    std::vector<ModeLabel>              labels;
    std::array<int, 3>                  count{};
    const int                           n_pins    = axes.size();
    const std::array<int, 3>            per_order = {{2 * n_pins, n_pins, n_pins}};
    for (Eigen::Index m = 0; m < modes.cols(); ++m)
      {
        Eigen::Index f;
        energies.col(m).maxCoeff(&f);
        labels.push_back({families[f], 0, 0, count[f]++ / per_order[f] + 1});
      }
    return labels;
  }
} // namespace Squeal
