// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/model.h>

#include <array>
#include <vector>

namespace Squeal
{
  /// Shape functions of a cell or face at its quadrature points, as an isoparametric element of its nodes.
  class ElementValues
  {
  public:
    explicit ElementValues(const Model &model)
      : ElementValues(model, model.degree())
    {}

    /// @param degree of the rule, see quadrature()
    ElementValues(const Model &model, unsigned int degree);

    /// Of an element of the model, at the points of quadrature().
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

    /// ∇N_i of a cell [1/m].
    const dealii::Tensor<1, 3> &gradient(const unsigned int i, const unsigned int q) const
    {
      return gradients[q * now->n_nodes + i];
    }

    /// Volume or area times weight [m³ or m²]; not positive where a cell is turned inside out.
    double JxW(const unsigned int q) const
    {
      return weights[q];
    }

    /// Place of a quadrature point [m].
    const dealii::Point<3> &point(const unsigned int q) const
    {
      return places[q];
    }

    /// Outward unit normal of a face.
    const dealii::Tensor<1, 3> &normal(const unsigned int q) const
    {
      return normals[q];
    }

    /// ∂x/∂ξ of a cell.
    const dealii::Tensor<2, 3> &jacobian(const unsigned int q) const
    {
      return jacobians[q];
    }

    const dealii::Point<3> &reference_point(const unsigned int q) const
    {
      return now->points[q].x;
    }

    /// The element of the last reinit().
    const NodalElement &element() const
    {
      return *current;
    }

    /// Place of a node of that element [m].
    dealii::Point<3> node(unsigned int i) const;

  private:
    /// What elements of one shape have in common.
    struct Table
    {
      unsigned int                      n_nodes = 0;
      std::vector<QuadraturePoint>      points;
      std::vector<double>               values;
      std::vector<dealii::Tensor<1, 3>> gradients; ///< with respect to reference coordinates
    };

    const Table &table(Shape shape);

    const Model                      &model;
    unsigned int                      degree; ///< of the rule
    std::array<Table, 6>              tables;
    const Table                      *now     = nullptr;
    const NodalElement               *current = nullptr;
    std::vector<dealii::Tensor<1, 3>> gradients, normals;
    std::vector<dealii::Tensor<2, 3>> jacobians;
    std::vector<double>               weights;
    std::vector<dealii::Point<3>>     places;
  };
} // namespace Squeal
