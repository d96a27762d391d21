#include "runtime/libero/released.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "runtime/base/hash_number.h"
#include "runtime/base/sha256.h"

namespace probe::libero {
namespace {

struct Released {
  std::string_view folder;
  std::size_t number;
  std::uint64_t problem, starts;
};
constexpr Released kReleased[] = {
#define LIBERO_RELEASED(folder, number, problem, starts) {#folder, number, problem, starts},
#include "runtime/libero/released.def"
};

constexpr std::string_view kRobosuiteFiles[] = {
#define LIBERO_ROBOSUITE(path, hash) path,
#include "runtime/libero/released.def"
};
constexpr std::uint64_t kRobosuiteHashes[] = {
#define LIBERO_ROBOSUITE(path, hash) hash,
#include "runtime/libero/released.def"
};

std::string without_returns(std::string_view text) {
  std::string plain(text);
  std::erase(plain, '\r');
  return plain;
}

std::uint64_t number_of(std::string_view bytes) { return big_endian_number(sha256(bytes)); }

bool is_known(std::string_view folder, std::size_t number, std::uint64_t Released::*what,
              std::uint64_t found) {
  const auto* const known = std::ranges::find_if(kReleased, [&](const Released& one) {
    return one.folder == folder && one.number == number;
  });
  return known != std::end(kReleased) && known->*what == found;
}

}  // namespace

bool is_released_problem(std::string_view folder, std::size_t number, std::string_view text) {
  return is_known(folder, number, &Released::problem, number_of(without_returns(text)));
}

bool are_released_starts(std::string_view folder, std::size_t number, std::string_view bytes) {
  return is_known(folder, number, &Released::starts, number_of(bytes));
}

std::span<const std::string_view> released_robosuite_files() { return kRobosuiteFiles; }

bool is_released_robosuite(std::string_view path, std::string_view text) {
  for (std::size_t i = 0; i < std::size(kRobosuiteFiles); ++i) {
    if (kRobosuiteFiles[i] == path) return kRobosuiteHashes[i] == number_of(without_returns(text));
  }
  return false;
}

}  // namespace probe::libero
