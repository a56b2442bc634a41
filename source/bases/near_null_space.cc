#include <squeal/bases/near_null_space.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/contact/contact_operators.h>

namespace Squeal
{
  NearNullSpace near_null_space(const Model &model, const SparseMatrix &kernel)
  {
    MultiVector motions(model.free_map(), 6), points(model.free_map(), 1);
    for (unsigned int component = 0; component < model.component_names().size(); ++component)
      motions += rigid_motions(model, component);
    for (std::size_t node = 0; node < model.nodes().size(); ++node)
      for (const int dof : model.nodes()[node].dofs)
        if (const int i = points.map().place(dof); i >= 0)
          points(i, 0) = static_cast<double>(node);

    NearNullSpace     result{coordinates(kernel, motions), {}};
    const MultiVector selected = coordinates(kernel, points);
    for (int i = 0; i < selected.n_local_rows(); ++i)
      result.points.push_back(static_cast<int>(selected(i, 0)));
    return result;
  }
} // namespace Squeal
