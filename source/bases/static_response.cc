#include <squeal/bases/rigid_body.h>
#include <squeal/bases/static_response.h>

namespace Squeal
{
  StaticResponse::StaticResponse(const Model               &model,
                                 const SecondOrderSystem   &system,
                                 const double               largest_circular_frequency,
                                 const FactorizationLibrary library)
    : InertiaRelief(system.stiffness,
                    system.mass,
                    free_disc_motions(model, system, largest_circular_frequency),
                    largest_circular_frequency,
                    library,
                    "stiffness of disc and pins without contact")
  {}
} // namespace Squeal
