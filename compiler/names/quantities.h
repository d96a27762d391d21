// Numbers with units as they are written: read in exact decimals, checked for their dimension,
// given in SI. Turns are made of them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/names/context.h"

namespace probe::sema {

// `takes` finishes the message at the number: "`density` takes a density".
std::optional<Quantity> read_quantity(Context& context, const syntax::Quantity& written,
                                      const Dimension& wanted, std::string_view takes);
std::optional<double> read_si(Context& context, const syntax::Quantity& written,
                              const Dimension& wanted, std::string_view takes);
// As read_si, and P0304 unless the value is above zero.
std::optional<double> read_positive(Context& context, const syntax::Quantity& written,
                                    const Dimension& wanted, std::string_view takes);
// Every coordinate, of which there must be `least` to `most`.
std::optional<std::vector<Quantity>> read_point(Context& context, const syntax::Point& point,
                                                std::size_t least, std::size_t most,
                                                const Dimension& wanted, std::string_view takes);
std::optional<Turn> read_turn(Context& context, const syntax::Pose& pose);
std::optional<std::vector<Turn>> read_turns(Context& context,
                                            const std::vector<syntax::Pose>& poses);
Turn make_turn(const Quantity* roll, const Quantity* pitch, const Quantity* yaw);

}  // namespace probe::sema
