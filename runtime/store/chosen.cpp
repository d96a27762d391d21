#include "runtime/store/chosen.h"

#include <charconv>
#include <span>

#include "runtime/base/file.h"
#include "runtime/base/inside.h"

namespace probe::store {
namespace {

constexpr const char* kChosen = "chosen";

}  // namespace

void write_chosen(const std::string& dir, std::int64_t episodes) {
  const std::string text = std::to_string(episodes) + "\n";
  if (const auto file = file_inside(dir, kChosen))
    (void)write_file(*file, std::as_bytes(std::span(text)));
}

std::optional<std::int64_t> read_chosen(const std::string& dir) {
  const auto text = read_file(dir + "/" + kChosen, {.most = 64});
  std::int64_t number = 0;
  if (!text) return std::nullopt;
  const auto read = std::from_chars(text->data(), text->data() + text->size(), number);
  if (read.ec != std::errc() || number < 0) return std::nullopt;
  return number;
}

}  // namespace probe::store
