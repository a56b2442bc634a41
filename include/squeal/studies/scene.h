#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/geometry/hex_mesh.h>
#include <squeal/model/model.h>
#include <squeal/sliding/steady_sliding.h>
#include <squeal/studies/run.h>

#include <memory>
#include <optional>

namespace Squeal
{
  /// The bodies before anything is said about their contact.
  struct Scene
  {
    HexMesh                mesh;
    std::unique_ptr<Model> model;
    ContactInterface       interface; ///< all pairs of contact nodes
    ContactOperators       contact;   ///< of all pairs
    std::vector<Term>      bodies;    ///< merged terms of the uncoupled bodies
    SecondOrderSystem      system;    ///< M, C, K: their sum

    unsigned int n_pins() const;
  };

  /**
   * The state of contact about which a scene is linearised, and the system that
   * results: only closed contact nodes couple the bodies.
   */
  struct Linearisation
  {
    std::optional<SlidingState> sliding;   ///< where the state is steady sliding
    std::vector<double>         reactions; ///< R_n0 of all pairs [N]; zero at open ones
    std::vector<unsigned int>   closed;    ///< numbers of the closed pairs: S_0
    ContactInterface            interface; ///< S_0
    ContactOperators            contact;   ///< of S_0
    ContactDamping              damping;   ///< of S_0
    CoupledSystem               coupled;

    /// Values of the closed pairs, set among those of all pairs; the others are zero.
    template <typename Number>
    std::vector<Number> on_all_pairs(const std::vector<Number> &values, const std::size_t n_pairs) const
    {
      std::vector<Number> result(n_pairs, Number());
      for (std::size_t i = 0; i < closed.size(); ++i)
        result[closed[i]] = values[i];
      return result;
    }
  };

  /// Meshes, checks and pairs; refuses parameters that do not fit the pins. The system is left empty.
  Scene mesh_scene(Run &run);

  /// Assembles the system of the uncoupled bodies.
  void assemble_scene(Scene &scene, Run &run);

  /// The quasi-static state that @p sliding asks for, as a step of the run.
  SlidingState solve_sliding(const Scene &scene, const OperationParameters &operation, const SlidingParameters &sliding, Run &run);

  /// Assembles the scene and linearises it about the state of contact that the parameters ask for, as steps of the run.
  Linearisation linearised_scene(Scene &scene, Run &run);

  /**
   * Couples the closed nodes of a state; where @p state is null all are closed
   * with equal shares of the load. The contact damping follows @p operation.
   */
  Linearisation linearise(const Scene &scene, const SlidingState *state, const OperationParameters &operation);
} // namespace Squeal
