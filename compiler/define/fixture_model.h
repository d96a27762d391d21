// A fixture as its URDF describes it.
#pragma once

#include "compiler/names/context.h"

namespace probe::sema {

// Fills model, joints, parts and regions of a fixture of which everything else has been read;
// reported: what the text says of joints and links that the description does not have.
void read_description(Context& context, Fixture& fixture);

bool is_within(const Fixture::Joint& joint, double position);
// P0304 of a joint that starts beyond its limits.
void outside(Context& context, const Span& span, const Fixture::Joint& joint, double position);

}  // namespace probe::sema
