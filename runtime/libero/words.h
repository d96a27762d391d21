// How instructions call LIBERO's things, and what their names prove of them: words.def.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace probe::libero {

// "black bowl" of akita_black_bowl; empty of what the table does not have.
std::string_view name_of(std::string_view category);
// "bowls" of it: what may stand in its place, as asked.probe calls the tasks that move it; empty
// where nothing is like it.
std::string_view set_of(std::string_view category);
// "top drawer" of cabinet_top, "top of the cabinet" of top_side, of a wooden_cabinet; empty as
// above.
std::string_view name_of(std::string_view category, std::string_view own);

// A declaration as `assets mujoco` writes it, with these names, attributes, facts and phrases, but
// for phrases of what `is_there` does not have ("nearest(plate_1)"); as it was where the table has
// nothing of it.
std::string described(std::string_view category, std::string declaration,
                      const std::function<bool(std::string_view)>& is_there);

}  // namespace probe::libero
