// Whether files are those of the released benchmark: of another version its published numbers say
// nothing.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace probe::libero {

// The text of a .bddl file, of the suite in `folder`, by the task's number there; how its lines end
// is nothing to it. False of a task that the release does not have.
bool is_released_problem(std::string_view folder, std::size_t number, std::string_view text);
// The same of the bytes of its .pruned_init file.
bool are_released_starts(std::string_view folder, std::size_t number, std::string_view bytes);

// Files of robosuite 1.4.1 that an import takes over or stands for, by their paths below its
// models/assets.
std::span<const std::string_view> released_robosuite_files();
// Whether the text of one of them is that version's.
bool is_released_robosuite(std::string_view path, std::string_view text);

}  // namespace probe::libero
