#include <squeal/bases/mode_labels.h>
#include <squeal/linear_algebra/communication.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>

namespace Squeal
{
  namespace
  {
    std::string text_of(const ModeLabel &label, const std::string &blank, const char *minus, const char *plus)
    {
      std::string text = to_string(label.family);
      if (label.rank > 0)
        text += label.body + blank + std::to_string(label.rank);
      else if (label.family != ModeFamily::unnamed && label.family != ModeFamily::rigid_body)
        text += std::to_string(label.nodal_circles) + "-" + std::to_string(label.nodal_diameters);
      return text + (label.sign == DoubletSign::none ? "" : label.sign == DoubletSign::minus ? minus : plus);
    }

    /// Norm of what projection leaves of a function r^k e^{inθ}, over its norm, up to which the others span it: well above rounding errors.
    constexpr double smallest_rest = 1e-8;

    /// The same sums over the processes on all of them, to the last bit.
    DenseMatrix summed(const MPI_Comm communicator, DenseMatrix parts)
    {
      sum_over_processes(communicator, parts.data(), parts.size());
      agree(communicator, parts);
      return parts;
    }

    /// Least-squares projection of nodal fields on a few functions in the mass-weighted inner product, a part of the nodes on each process.
    class Projection
    {
    public:
      /**
       * @param functions  n_nodes × n_functions, rows of this process
       * @param weights    n_nodes
       */
      Projection(const MPI_Comm communicator, const DenseMatrix &functions, const Eigen::VectorXd &weights)
        : communicator(communicator)
        , roots(weights.cwiseSqrt())
        , Q(roots.asDiagonal() * functions)
        , R(DenseMatrix::Identity(functions.cols(), functions.cols()))
      {
        // Gram-Schmidt, twice; functions that others span (r^k on a single radius) are dropped
        for (Eigen::Index j = 0; j < Q.cols(); ++j)
          {
            const double before = norm(j);
            for (int pass = 0; pass < 2 && j > 0; ++pass)
              {
                // A one-column matrix: for a vector Eigen calls gemv with a leading dimension of zero on processes without rows
                const DenseMatrix c = summed(communicator, Q.leftCols(j).transpose() * Q.middleCols(j, 1));
                R.col(j).head(j) += c.col(0);
                Q.middleCols(j, 1).noalias() -= Q.leftCols(j) * c;
              }
            const double after = norm(j);
            if (after / before > smallest_rest)
              {
                R(j, j) = after;
                Q.col(j) /= after;
              }
            else
              Q.col(j).setZero();
          }
      }

      /// Orthonormal coefficients of fields, n_functions × k; the sum of their squares is the energy of the projection.
      DenseMatrix coefficients(const DenseMatrix &fields) const
      {
        return summed(communicator, Q.transpose() * (roots.asDiagonal() * fields));
      }

      /// Factors of the functions from orthonormal coefficients.
      Eigen::VectorXd factors(const Eigen::VectorXd &orthonormal_coefficients) const
      {
        return R.triangularView<Eigen::Upper>().solve(orthonormal_coefficients);
      }

    private:
      double norm(const Eigen::Index j) const
      {
        return std::sqrt(summed(communicator, DenseMatrix::Constant(1, 1, Q.col(j).squaredNorm()))(0, 0));
      }

      MPI_Comm        communicator;
      Eigen::VectorXd roots; ///< of the weights
      DenseMatrix     Q, R;  ///< functions times roots = Q R; dropped ones are zero in Q and have ones on the diagonal of R
    };

    /// 1, x, x², ... as columns.
    DenseMatrix powers(const Eigen::VectorXd &x, const int n_powers)
    {
      DenseMatrix result = DenseMatrix::Ones(x.size(), n_powers);
      for (int k = 1; k < n_powers; ++k)
        result.col(k) = result.col(k - 1).cwiseProduct(x);
      return result;
    }

    /// Nodes of one component whose rows this process has. Clamped ones, which nobody has, are at rest.
    struct Nodes
    {
      MPI_Comm                        communicator;
      std::vector<std::array<int, 3>> rows;      ///< places of the displacements
      Eigen::MatrixX3d                positions; ///< [m]
      Eigen::VectorXd                 masses;    ///< [kg]

      Nodes(const Model &model, const std::vector<double> &nodal_masses, const unsigned int component)
        : communicator(model.communicator())
      {
        const RowMap             &map = model.free_map();
        std::vector<const Node *> nodes;
        std::vector<double>       chosen;
        for (std::size_t i = 0; i < nodal_masses.size(); ++i)
          if (const Node &node = model.nodes()[i]; node.component == component && map.place(node.dofs[0]) >= 0)
            {
              nodes.push_back(&node);
              rows.push_back({{map.place(node.dofs[0]), map.place(node.dofs[1]), map.place(node.dofs[2])}});
              chosen.push_back(nodal_masses[i]);
            }
        masses = as_column(chosen);
        positions.resize(nodes.size(), 3);
        for (std::size_t i = 0; i < nodes.size(); ++i)
          positions.row(i) = Eigen::RowVector3d::Map(nodes[i]->position.data());
      }

      Eigen::MatrixX3d displacements(const MultiVector &modes, const int j) const
      {
        Eigen::MatrixX3d u(rows.size(), 3);
        for (std::size_t i = 0; i < rows.size(); ++i)
          for (unsigned int k = 0; k < 3; ++k)
            u(i, k) = modes(rows[i][k], j);
        return u;
      }

      double largest(const Eigen::VectorXd &values) const
      {
        return largest_of_processes(communicator, values.size() > 0 ? values.maxCoeff() : -std::numeric_limits<double>::infinity());
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
        const double inner = -disc.largest(-radii), outer = disc.largest(radii);
        radial = powers((2. * radii.array() - inner - outer) / (outer - inner), n_radial_functions);
        for (int n = 0; n <= largest_harmonic; ++n)
          {
            DenseMatrix functions(radii.size(), (n == 0 ? 1 : 2) * n_radial_functions);
            functions.leftCols(n_radial_functions) = (n * theta).array().cos().matrix().asDiagonal() * radial;
            if (n > 0)
              functions.rightCols(n_radial_functions) = (n * theta).array().sin().matrix().asDiagonal() * radial;
            harmonics.emplace_back(disc.communicator, functions, disc.masses);
          }
      }

      /// Axial, radial and circumferential displacement of the nodes.
      Eigen::MatrixX3d cylindrical(const MultiVector &modes, const int j) const
      {
        const Eigen::MatrixX3d u = disc.displacements(modes, j);
        Eigen::MatrixX3d       fields(u.rows(), 3);
        fields << u.col(2), cosines.cwiseProduct(u.col(0)) + sines.cwiseProduct(u.col(1)),
          cosines.cwiseProduct(u.col(1)) - sines.cwiseProduct(u.col(0));
        return fields;
      }

      /// Sign changes of the radial profile of harmonic n: of its cosine and sine amplitudes in narrow rings, along their common direction
      /// in the cosine-sine plane, as the nodal line pattern may be turned.
      int nodal_circles(const Eigen::VectorXd &coefficients, const int n) const
      {
        // Profile a(r) cos nθ + b(r) sin nθ
        constexpr int         n_samples = 41;
        const DenseMatrix     radial    = powers(Eigen::VectorXd::LinSpaced(n_samples, -1., 1.), n_radial_functions);
        const Eigen::VectorXd factors   = harmonics[n].factors(coefficients);
        const Eigen::VectorXd a         = radial * factors.head(n_radial_functions);
        const Eigen::VectorXd b = n > 0 ? Eigen::VectorXd(radial * factors.tail(n_radial_functions)) : Eigen::VectorXd::Zero(n_samples);

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
        DenseMatrix                    fields(real_part.size(), 2);
        fields << real_part, imaginary_part;
        const DenseMatrix      coefficients = harmonics[n].coefficients(fields);
        const Eigen::VectorXcd factors      = harmonics[n].factors(coefficients.col(0)) + i * harmonics[n].factors(coefficients.col(1));
        const Eigen::VectorXcd a = radial * factors.head(n_radial_functions), b = radial * factors.tail(n_radial_functions);
        const DenseMatrix      parts =
          summed(disc.communicator,
                 (DenseMatrix(2, 1) << disc.masses.dot((a + i * b).cwiseAbs2()), disc.masses.dot((a - i * b).cwiseAbs2())).finished());
        const double both = parts.sum();
        return both > 0. ? std::make_optional(WaveShares{parts(0, 0) / both, parts(1, 0) / both}) : std::nullopt;
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
    void add_energies(const Nodes &pin, const PinAxis &axis, const MultiVector &modes, DenseMatrix &energies)
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

      const DenseMatrix functions = powers(heights / pin.largest(heights.cwiseAbs()), n_height_functions);
      const Projection  translation(pin.communicator, functions, pin.masses),
        torsion(pin.communicator, radii.asDiagonal() * functions, pin.masses);

      for (int m = 0; m < modes.n_columns(); ++m)
        {
          const Eigen::MatrixX3d u       = pin.displacements(modes, m);
          const Eigen::VectorXd  axially = u * along;
          energies(0, m) += translation.coefficients(u - axially * along.transpose()).squaredNorm();
          energies(1, m) += torsion.coefficients(u.cwiseProduct(around).rowwise().sum()).squaredNorm();
          energies(2, m) += translation.coefficients(axially).squaredNorm();
        }
    }

    bool is_pin(const Model &model, const std::size_t body)
    {
      return model.component_names()[body].rfind(PhysicalNames::pin_prefix, 0) == 0;
    }

    /// Σ m |u|² over the nodes of each body, bodies × modes.
    DenseMatrix body_energies(const Model &model, const std::vector<double> &nodal_masses, const MultiVector &modes)
    {
      DenseMatrix result = DenseMatrix::Zero(model.component_names().size(), modes.n_columns());
      for (std::size_t i = 0; i < nodal_masses.size(); ++i)
        for (const int dof : model.nodes()[i].dofs)
          if (const int row = modes.map().place(dof); row >= 0)
            result.row(model.nodes()[i].component) += nodal_masses[i] * modes.local().row(row).cwiseAbs2();
      return summed(model.communicator(), result);
    }
  } // namespace

  bool operator==(const ModeLabel &a, const ModeLabel &b)
  {
    return a.shape() == b.shape() && a.sign == b.sign;
  }

  std::string to_string(const ModeLabel &label)
  {
    return text_of(label, label.body.empty() ? "" : " ", " -", " +");
  }

  std::string file_text(const ModeLabel &label)
  {
    return text_of(label, label.body.empty() ? "" : "_", "_minus", "_plus");
  }

  std::string shape_text(ModeLabel label)
  {
    label.sign = DoubletSign::none;
    return to_string(label);
  }

  void mark_doublets(std::vector<ModeLabel> &labels, const std::vector<double> &growth_rates)
  {
    std::map<ModeShape, std::vector<std::size_t>> places;
    for (std::size_t i = 0; i < labels.size(); ++i)
      if (labels[i].family != ModeFamily::unnamed)
        places[labels[i].shape()].push_back(i);
    for (const auto &[shape, modes] : places)
      if (modes.size() == 2)
        {
          const bool first_grows_more           = !growth_rates.empty() && growth_rates[modes[0]] > growth_rates[modes[1]];
          labels[modes[!first_grows_more]].sign = DoubletSign::plus;
          labels[modes[first_grows_more]].sign  = DoubletSign::minus;
        }
  }

  std::vector<ModeLabel> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const MultiVector &modes)
  {
    const DiscHarmonics    disc(model, nodal_masses);
    std::vector<ModeLabel> labels;
    for (int j = 0; j < modes.n_columns(); ++j)
      {
        const Eigen::MatrixX3d   fields = disc.cylindrical(modes, j);
        std::vector<DenseMatrix> coefficients;
        for (const Projection &harmonic : disc.harmonics)
          coefficients.push_back(harmonic.coefficients(fields));

        // Harmonic of the largest energy, the three directions together
        DenseMatrix energies(3, largest_harmonic + 1);
        for (int n = 0; n <= largest_harmonic; ++n)
          energies.col(n) = coefficients[n].colwise().squaredNorm();
        Eigen::Index diameters, family;
        energies.colwise().sum().maxCoeff(&diameters);
        energies.col(diameters).maxCoeff(&family);
        labels.push_back({disc_families[family], disc.nodal_circles(coefficients[diameters].col(family), static_cast<int>(diameters)),
                          static_cast<int>(diameters)});
      }
    return labels;
  }

  std::vector<std::optional<WaveShares>> wave_shares(const Model                  &model,
                                                     const std::vector<double>    &nodal_masses,
                                                     const std::vector<ModeLabel> &labels,
                                                     const MultiVector            &real_part,
                                                     const MultiVector            &imaginary_part)
  {
    const DiscHarmonics                    disc(model, nodal_masses);
    std::vector<std::optional<WaveShares>> shares(labels.size());
    for (std::size_t j = 0; j < labels.size(); ++j)
      for (std::size_t component = 0; component < disc_families.size(); ++component)
        if (labels[j].family == disc_families[component] && labels[j].nodal_diameters > 0)
          shares[j] = disc.wave_shares(disc.cylindrical(real_part, static_cast<int>(j)).col(component),
                                       disc.cylindrical(imaginary_part, static_cast<int>(j)).col(component), labels[j].nodal_diameters);
    return shares;
  }

  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const MultiVector         &modes)
  {
    auto axes = pin_axes(interface);
    for (auto axis = axes.begin(); axis != axes.end();)
      axis = is_pin(model, axis->first) ? std::next(axis) : axes.erase(axis);
    const DenseMatrix           of_bodies = body_energies(model, nodal_masses, modes);
    std::map<Eigen::Index, int> n_of_body;
    DenseMatrix                 energies = DenseMatrix::Zero(3, modes.n_columns());
    for (const auto &[pin, axis] : axes)
      add_energies(Nodes(model, nodal_masses, pin), axis, modes, energies);

    // Numbers within each family, by the number of modes that every pin has of it
    constexpr std::array<ModeFamily, 3> families = {{ModeFamily::flexural, ModeFamily::torsional, ModeFamily::longitudinal}};
    std::vector<ModeLabel>              labels;
    std::array<int, 3>                  count{};
    const int                           n_pins    = axes.size();
    const std::array<int, 3>            per_order = {{2 * n_pins, n_pins, n_pins}};
    for (int m = 0; m < modes.n_columns(); ++m)
      {
        Eigen::Index f, body;
        of_bodies.col(m).maxCoeff(&body);
        if (!is_pin(model, body))
          {
            labels.push_back({ModeFamily::body, 0, 0, ++n_of_body[body], DoubletSign::none, 0., model.component_names()[body]});
            continue;
          }
        energies.col(m).maxCoeff(&f);
        labels.push_back({families[f], 0, 0, count[f]++ / per_order[f] + 1});
      }
    return labels;
  }
} // namespace Squeal
