// Small numbers for whatever must be told apart: 0, 1, 2 in the order of coming. Header only.
#pragma once

#include <cstdint>
#include <map>

namespace probe {

template <typename Key>
class Numbering {
 public:
  std::uint32_t operator()(const Key& key) {
    return numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }

 private:
  std::map<Key, std::uint32_t> numbers_;
};

}  // namespace probe
