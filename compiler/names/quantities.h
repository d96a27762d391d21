// Numbers with units as they are written: read in exact decimals, checked for their dimension,
// given in SI. Turns are made of them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/names/context.h"
#include "runtime/plan/magnitudes.h"

namespace probe::sema {

// What a statement takes, to finish the message at the number: "`density` takes a density".
struct Takes {
  std::string_view text;
  std::optional<plan::Magnitude> magnitude;  // what a plan holds of it; none: any number
  bool is_place = false;                     // on the surface, whose size is then a hint

  Takes(const char* words, std::optional<plan::Magnitude> of = {}) : text(words), magnitude(of) {}
  static Takes places(const char* words) {
    Takes takes(words, plan::Magnitude::kPlace);
    takes.is_place = true;
    return takes;
  }
};

// P0304 for a value that world and renderer cannot compute with (runtime/plan/magnitudes.def).
// Whether it is none.
bool check_magnitude(Context& context, const Span& span, double value, plan::Magnitude magnitude);

std::optional<Quantity> read_quantity(Context& context, const syntax::Quantity& written,
                                      const Dimension& wanted, const Takes& takes);
std::optional<double> read_si(Context& context, const syntax::Quantity& written,
                              const Dimension& wanted, const Takes& takes);
// As read_si, and P0304 unless the value is above zero.
std::optional<double> read_positive(Context& context, const syntax::Quantity& written,
                                    const Dimension& wanted, const Takes& takes);
// Every coordinate, of which there must be `least` to `most`.
std::optional<std::vector<Quantity>> read_point(Context& context, const syntax::Point& point,
                                                std::size_t least, std::size_t most,
                                                const Dimension& wanted, const Takes& takes);
std::optional<Turn> read_turn(Context& context, const syntax::Pose& pose);
std::optional<std::vector<Turn>> read_turns(Context& context,
                                            const std::vector<syntax::Pose>& poses);
Turn make_turn(const Quantity* roll, const Quantity* pitch, const Quantity* yaw);

}  // namespace probe::sema
