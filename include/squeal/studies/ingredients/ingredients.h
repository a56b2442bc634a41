#pragma once

#include <squeal/studies/steps/model_variants.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// What a change of the model is good for.
  enum class ChangeKind
  {
    removes, ///< makes the model simpler: the cheapest one may have it
    adds,    ///< what the scene leaves out
    speeds,  ///< another way to the same modes: the cheapest model may have it where it is faster
    shows    ///< what matters, no more: no parameters make a model of that kind
  };

  /// A part of the model that may be switched on, off, or over to something else, by itself.
  struct Ingredient
  {
    const char *name;

    /// What the scene has, and what is tried in its place, in a few words.
    std::string (*here)(const Parameters &);
    std::string (*tried)(const Parameters &);

    /// Whether the scene is that way already, so that there is nothing to try.
    bool (*is_present)(const Parameters &);

    /// Makes the change. What no parameter expresses is changed in the variation.
    void (*change)(Variation &);

    ChangeKind kind;
    Departure  departure;

    /// Why the scene cannot have it; null if it can. Null: it always can.
    Reason (*obstacle)(const Parameters &, const std::optional<SlidingState> &) = nullptr;
  };

  /// All ingredients; of those with one name the simplest first.
  const std::vector<Ingredient> &ingredients();

  /// Those of which a scene differs, in the order of the list.
  std::vector<const Ingredient *> ingredients_to_try(const Parameters &parameters);

  /// The scene with some ingredients changed, from the earliest of their departures.
  Variation combined(const Parameters &parameters, const std::vector<const Ingredient *> &changed);
} // namespace Squeal
