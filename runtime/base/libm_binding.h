// Which sine and cosine the code of other libraries calls. glibc picks versions with or without FMA
// at run time, whose last bits differ. A program that defines `sin` itself (runtime/world/libm)
// gives it to every library; a shared library that is loaded into somebody else's program cannot,
// because that program's libm comes first. There the libraries' own tables of imported functions
// are written: the binding holds whoever loads us, and says so.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

namespace probe {

struct TrigBinding {
  int libraries = 0;  // with a name that was asked for, this one included
  int slots = 0;      // that now lead to our functions
};

// Gives every loaded library whose file name begins with one of `names`, and the program or library
// that this function is part of, our sin, cos and sincos. Others, such as those of the program that
// has loaded us, stay as they are. May be called again, and from any thread before the libraries
// are used. Fails (kWorld, where = the library) when a table cannot be written.
Result<TrigBinding> bind_trigonometry(std::span<const std::string_view> names);

}  // namespace probe
