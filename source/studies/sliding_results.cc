#include <squeal/linear_algebra/replicate.h>
#include <squeal/studies/mode_tables.h>
#include <squeal/studies/sliding_results.h>

namespace Squeal
{
  namespace
  {
    std::string uniqueness_note(const ContactUniqueness &uniqueness)
    {
      if (uniqueness.is_certified)
        return text("it is the only one: mu < ", uniqueness.unique_below);
      if (uniqueness.found_other)
        return "it is NOT the only one: another contact set fulfils all conditions too; the one found first is used";
      return text("whether it is the only one is not certified",
                  uniqueness.unique_below > 0. ? text(" above mu = ", uniqueness.unique_below) : "", "; ", uniqueness.n_searches,
                  " searches from other contact sets found no other");
    }
  } // namespace

  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run)
  {
    const std::vector<PinContact> pins =
      pin_contacts(*scene.model, scene.interface, state.reactions, state.gaps, state.approach, operation);
    run.store_table("sliding_pins", pin_table(pins));
    run.store_table("sliding_certificate", sliding_table(state, pins));

    std::string open;
    for (const PinContact &pin : pins)
      if (pin.n_open > 0)
        open +=
          text(open.empty() ? "" : ", ", pin.pin, pin.n_open == pin.n_nodes ? " (all)" : text(" (", pin.n_open, " of ", pin.n_nodes, ")"));
    run.progress.note("  steady sliding: " + (open.empty() ? "all contact nodes are closed" : "open contact nodes of " + open));
    run.progress.note("  steady sliding: " + uniqueness_note(state.uniqueness));
  }

  void write_sliding_fields(const Scene &scene, const SlidingState &state, const OperationParameters &operation, const FieldWriter &writer)
  {
    const DenseMatrix u = replicate(*state.total_displacement);
    writer.write_contact_state({std::vector<double>(u.column(), u.column() + u.n_rows()), state.approach, state.reactions, state.gaps,
                                radial_dissipation(scene.interface, state.reactions, operation),
                                sliding_dissipation(state.reactions, operation)});
  }
} // namespace Squeal
