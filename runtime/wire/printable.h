// Texts of a server, fit to be shown and stored.
#pragma once

#include "runtime/base/printable.h"

namespace probe::wire {

using probe::printable;

}  // namespace probe::wire
