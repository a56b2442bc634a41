// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/model.h>

#include <array>
#include <vector>

namespace Squeal
{
  /// Isoparametric shape functions of a cell or face at its quadrature points.
  class ElementValues
  {
  public:
    explicit ElementValues(const Model &model)
      : ElementValues(model, model.degree())
    {}

    /// @param degree degree of the quadrature rule, see quadrature()
    ElementValues(const Model &model, unsigned int degree);

    /// Evaluates an element of the model at the points of quadrature().
    void reinit(const NodalElement &element);

    unsigned int n_nodes() const
    {
      return now->n_nodes;
    }

    unsigned int n_points() const
    {
      return now->points.size();
    }

    double value(const unsigned int i, const unsigned int q) const
    {
      return now->values[q * now->n_nodes + i];
    }

    /// ∇N_i in a cell [1/m].
    const dealii::Tensor<1, 3> &gradient(const unsigned int i, const unsigned int q) const
    {
      return gradients[q * now->n_nodes + i];
    }

    /// Volume or area element times quadrature weight [m³ or m²]; not positive where a cell is inverted.
    double JxW(const unsigned int q) const
    {
      return weights[q];
    }

    /// Position of a quadrature point [m].
    const dealii::Point<3> &point(const unsigned int q) const
    {
      return places[q];
    }

    /// Outward unit normal of a face.
    const dealii::Tensor<1, 3> &normal(const unsigned int q) const
    {
      return normals[q];
    }

    /// ∂x/∂ξ in a cell [m].
    const dealii::Tensor<2, 3> &jacobian(const unsigned int q) const
    {
      return jacobians[q];
    }

    const dealii::Point<3> &reference_point(const unsigned int q) const
    {
      return now->points[q].x;
    }

    /// Current element, from the last call of reinit().
    const NodalElement &element() const
    {
      return *current;
    }

    /// Position of a node of the current element [m].
    dealii::Point<3> node(unsigned int i) const;

  private:
    /// Data shared by all elements of one shape.
    struct Table
    {
      unsigned int                      n_nodes = 0;
      std::vector<QuadraturePoint>      points;
      std::vector<double>               values;
      std::vector<dealii::Tensor<1, 3>> gradients; ///< gradients with respect to reference coordinates
    };

    const Table &table(Shape shape);

    const Model                      &model;
    unsigned int                      degree;
    std::array<Table, 6>              tables;
    const Table                      *now     = nullptr;
    const NodalElement               *current = nullptr;
    std::vector<dealii::Tensor<1, 3>> gradients, normals;
    std::vector<dealii::Tensor<2, 3>> jacobians;
    std::vector<double>               weights;
    std::vector<dealii::Point<3>>     places;
  };
} // namespace Squeal
