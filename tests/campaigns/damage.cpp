#include "tests/campaigns/damage.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

#include "runtime/export/dataset/tfrecord.h"
#include "runtime/wire/msgpack.h"
#include "tests/runtime/scene/mutate.h"

namespace probe::campaign {
namespace {

using scene::test::Dice;

constexpr std::int64_t kNumbers[] = {0,
                                     -1,
                                     1,
                                     127,
                                     255,
                                     65'535,
                                     65'536,
                                     0x7fff'ffff,
                                     -0x8000'0000ll,
                                     0xffff'ffffll,
                                     0x1'0000'0000ll,
                                     0x7fff'ffff'ffff'ffffll};
constexpr std::size_t kDepths[] = {2, 63, 64, 65, 300, 499, 501, 20'000};

std::string repeated(std::string_view part, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += part;
  return all;
}

// A length, a count or a tag: 1, 2, 4 or 8 bytes of either order, at any place; or one that stands
// there a little more or less; or what a varint may have of continuation.
std::string damaged_lengths(std::string bytes, Dice& dice) {
  for (std::size_t changes = 1 + dice.below(3); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t size = std::size_t{1} << dice.below(4);
    if (bytes.size() < size) continue;
    const std::size_t at = dice.below(bytes.size() - size + 1);
    auto* const place = reinterpret_cast<std::uint8_t*>(bytes.data()) + at;
    const bool is_big_endian = dice.below(2) == 0;
    const auto shift = [&](std::size_t i) { return 8 * (is_big_endian ? size - 1 - i : i); };
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{place[i]} << shift(i);
    switch (dice.below(4)) {
      case 0:
        value = static_cast<std::uint64_t>(kNumbers[dice.below(std::size(kNumbers))]);
        break;
      case 1:
        value += dice.below(2) == 0 ? 1 : ~std::uint64_t{0};
        break;
      case 2:
        value = bytes.size() - at + dice.below(3);
        break;
      default:  // varints of ten bytes and more
        bytes.insert(at, std::string(1 + dice.below(12), static_cast<char>(0xff)));
        continue;
    }
    for (std::size_t i = 0; i < size; ++i) place[i] = static_cast<std::uint8_t>(value >> shift(i));
  }
  return bytes;
}

struct Stretch {
  std::size_t begin = 0, end = 0;
};

// Of one or several JSON texts; members are `"key": value`.
struct JsonParts {
  std::vector<Stretch> values, members;

  explicit JsonParts(std::string_view text) {
    constexpr std::size_t kNone = std::string_view::npos;
    std::vector<std::pair<std::size_t, std::size_t>> open;  // where it begins, and its key
    std::size_t key = kNone;
    const auto add = [&](std::size_t begin, std::size_t end) {
      values.push_back({begin, end});
      if (key != kNone) members.push_back({key, end});
      key = kNone;
    };
    for (std::size_t i = 0; i < text.size();) {
      const char c = text[i];
      if (c == '{' || c == '[') {
        open.emplace_back(i++, std::exchange(key, kNone));
      } else if (c == '}' || c == ']') {
        ++i;
        if (open.empty()) continue;
        key = open.back().second;
        add(open.back().first, i);
        open.pop_back();
      } else if (c == '"') {
        std::size_t end = i + 1;
        while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
        end = std::min(end + 1, text.size());
        const std::size_t behind = std::min(text.find_first_not_of(" \n\t", end), text.size());
        if (behind < text.size() && text[behind] == ':') {
          key = i;
          i = behind + 1;
        } else {
          add(i, end);
          i = end;
        }
      } else if (std::string_view(" \n\t\r,:").find(c) != kNone) {
        ++i;
      } else {
        const std::size_t end = std::min(text.find_first_of(" \n\t\r,]}", i), text.size());
        add(i, end);
        i = std::max(end, i + 1);
      }
    }
  }
};

std::string odd_json(Dice& dice) {
  static constexpr std::string_view kOdd[] = {"null",
                                              "true",
                                              "false",
                                              "-1",
                                              "0",
                                              "0.5",
                                              "-0.0",
                                              "1e999",
                                              "NaN",
                                              "1e308",
                                              "[]",
                                              "{}",
                                              "[[]]",
                                              "\"\"",
                                              "\"x\"",
                                              "\"1\"",
                                              "[1,\"a\",null]",
                                              "{\"a\":1}",
                                              "\"\\u0000\"",
                                              "\"\\ud800\"",
                                              "\"\\u001b[2J\"",
                                              "18446744073709551615",
                                              "-9223372036854775808",
                                              "99999999999999999999",
                                              "2147483648",
                                              "\"../../../etc\"",
                                              "\"\xff\xfe\""};
  switch (dice.below(8)) {
    case 0:
      return "\"" + std::string(1 + dice.below(70'000), 'a') + "\"";
    case 1: {
      const std::size_t depth = kDepths[dice.below(std::size(kDepths))];
      return std::string(depth, '[') + std::string(depth, ']');
    }
    default:
      return std::string(kOdd[dice.below(std::size(kOdd))]);
  }
}

std::string damaged_json(std::string text, Dice& dice) {
  for (std::size_t changes = 1 + dice.below(3); changes > 0; --changes) {
    const JsonParts parts(text);
    if (parts.values.empty()) return text;
    const auto any = [&](const std::vector<Stretch>& of) { return of[dice.below(of.size())]; };
    const auto words = [&](Stretch of) { return text.substr(of.begin, of.end - of.begin); };
    const auto put = [&](Stretch at, const std::string& with) {
      text.replace(at.begin, at.end - at.begin, with);
    };
    const Stretch value = any(parts.values);
    const std::size_t what = dice.below(9);
    if (what >= 6 && !parts.members.empty()) {
      const Stretch member = any(parts.members);
      if (what == 6) {  // it is lost
        Stretch gone = member;
        if (gone.end < text.size() && text[gone.end] == ',') ++gone.end;
        put(gone, "");
      } else if (what == 7) {  // it stands twice
        text.insert(member.begin, words(member) + ",");
      } else {  // another of its name
        const std::string key = words({member.begin, text.find(':', member.begin)});
        text.insert(member.end, "," + key + ":" + odd_json(dice));
      }
      continue;
    }
    switch (what) {
      case 0: {  // what stands elsewhere
        put(value, words(any(parts.values)));
        break;
      }
      case 1: {  // deeper
        const std::size_t depth = kDepths[dice.below(std::size(kDepths))];
        if (dice.below(2) == 0) {
          put(value, std::string(depth, '[') + words(value) + std::string(depth, ']'));
        } else {
          put(value, repeated("{\"a\":", depth) + words(value) + std::string(depth, '}'));
        }
        break;
      }
      case 2: {  // many
        const std::string one = words(value);
        const std::size_t count = std::min<std::size_t>(5000, 200'000 / (one.size() + 1));
        put(value, "[" + one + repeated("," + one, count) + "]");
        break;
      }
      default:
        put(value, odd_json(dice));
        break;
    }
  }
  return text;
}

std::string damaged_table(std::string text, Dice& dice) {
  static constexpr std::string_view kOdd[] = {"",           "-1",
                                              "nan",        "inf",
                                              "1e39",       "1e-400",
                                              "0x10",       " 1",
                                              "+1",         "1,2",
                                              "\"",         "\"a",
                                              "a\"b",       "99999999999999999999",
                                              "4294967296", "100.1",
                                              "101",        "1/0",
                                              "#",          "\t",
                                              "\r",         "\xef\xbb\xbf",
                                              "\xff",       ";",
                                              "=1+1",       "\x1b[2J"};
  for (std::size_t changes = 1 + dice.below(3); changes > 0; --changes) {
    std::vector<std::string> rows;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      rows.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    if (rows.empty()) return text;
    // The head as often as all that is behind it.
    const std::size_t at = dice.below(3) == 0 ? 0 : dice.below(rows.size());
    std::vector<std::string> cells;
    for (std::size_t begin = 0; begin <= rows[at].size();) {
      const std::size_t end = std::min(rows[at].find(',', begin), rows[at].size());
      cells.push_back(rows[at].substr(begin, end - begin));
      begin = end + 1;
    }
    const std::size_t cell = dice.below(cells.size());
    switch (dice.below(9)) {
      case 0:
        cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(cell));
        break;
      case 1:
        cells.push_back(cells[cell]);
        break;
      case 2:
        std::swap(cells[cell], cells[dice.below(cells.size())]);
        break;
      case 3:
        cells[cell] = std::string(1 + dice.below(70'000), 'a');
        break;
      default:
        cells[cell] = kOdd[dice.below(std::size(kOdd))];
        break;
    }
    std::string row;
    for (std::size_t i = 0; i < cells.size(); ++i) row += (i > 0 ? "," : "") + cells[i];
    rows[at] = std::move(row);
    switch (dice.below(8)) {
      case 0:
        rows.push_back(rows[at]);
        break;
      case 1:
        rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 2:
        std::swap(rows[at], rows[dice.below(rows.size())]);
        break;
      case 3:
        rows.insert(rows.end(), 300, rows[at]);
        break;
      default:
        break;
    }
    text.clear();
    for (const std::string& line : rows) text += line + "\n";
  }
  return text;
}

wire::Value odd_value(Dice& dice) {
  switch (dice.below(8)) {
    case 0:
      return {};
    case 1:
      return kNumbers[dice.below(std::size(kNumbers))];
    case 2:
      return dice.below(2) == 0 ? 1e308 * 10 : -0.0;
    case 3:
      return std::string(dice.below(3) * 40'000, '\x1b');
    case 4:
      return wire::Bytes(dice.below(100), 0xff);
    case 5:
      return wire::List{};
    case 6:
      return wire::Map{};
    default:
      return wire::List(1 + dice.below(2000), wire::Value(0.5));
  }
}

wire::Array odd_array(wire::Array array, Dice& dice) {
  static constexpr std::string_view kTypes[] = {"|u1", "<f4", "<f8", "<i4", "<i8", "|b1",
                                                "<f2", ">f8", "<U8", "|O",  "",    "<f999999999"};
  switch (dice.below(4)) {
    case 0:
      array.dtype = kTypes[dice.below(std::size(kTypes))];
      break;
    case 1:
      array.bytes.resize(dice.below(2 * array.bytes.size() + 1));
      break;
    case 2:
      array.shape.insert(array.shape.begin(), 1 + dice.below(40), 1);
      break;
    default: {
      const std::int64_t side = kNumbers[dice.below(std::size(kNumbers))];
      if (array.shape.empty()) {
        array.shape.push_back(side);
      } else {
        array.shape[dice.below(array.shape.size())] = side;
      }
      break;
    }
  }
  return array;
}

// The tree again with its `at`th node, counted as they come, in other words.
wire::Value with_damage(const wire::Value& value, std::size_t& at, Dice& dice) {
  const bool is_here = at-- == 0;
  if (is_here) {
    if (const auto* array = value.as<wire::Array>(); array != nullptr && dice.below(4) != 0)
      return odd_array(*array, dice);
    if (dice.below(3) == 0) {
      wire::Value deeper = value;
      for (std::size_t depth = dice.below(100); depth > 0; --depth) {
        if (dice.below(2) == 0) {
          deeper = wire::List{std::move(deeper)};
        } else {
          deeper = wire::Map{{"a", std::move(deeper)}};
        }
      }
      return deeper;
    }
    const auto* map = value.as<wire::Map>();
    if (map == nullptr || map->empty()) return odd_value(dice);
    wire::Map other = *map;
    const std::size_t key = dice.below(other.size());
    switch (dice.below(4)) {
      case 0:
        other.erase(other.begin() + static_cast<std::ptrdiff_t>(key));
        break;
      case 1:
        other.push_back({other[key].first, odd_value(dice)});
        break;
      case 2:
        other[key].first += dice.below(2) == 0 ? " " : std::string_view("\0", 1);
        break;
      default:
        return odd_value(dice);
    }
    return other;
  }
  if (const auto* list = value.as<wire::List>()) {
    wire::List other;
    for (const wire::Value& item : *list) other.push_back(with_damage(item, at, dice));
    return other;
  }
  if (const auto* map = value.as<wire::Map>()) {
    wire::Map other;
    for (const auto& [key, item] : *map) other.emplace_back(key, with_damage(item, at, dice));
    return other;
  }
  return value;
}

std::size_t nodes_of(const wire::Value& value) {
  std::size_t count = 1;
  if (const auto* list = value.as<wire::List>()) {
    for (const wire::Value& item : *list) count += nodes_of(item);
  }
  if (const auto* map = value.as<wire::Map>()) {
    for (const auto& [key, item] : *map) count += nodes_of(item);
  }
  return count;
}

std::string damaged_msgpack(const std::string& bytes, Dice& dice) {
  const auto read =
      wire::from_msgpack({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  if (!read) return damaged_lengths(bytes, dice);
  std::size_t at = dice.below(nodes_of(*read));
  const bool is_npy = bytes.find("as_npy") != bytes.npos;
  const wire::Bytes packed =
      wire::to_msgpack(with_damage(*read, at, dice), is_npy ? wire::ArrayStyle::kNpy
                                                     : bytes.find("\xa5"
                                                                  "dtype") == bytes.npos
                                                         ? wire::ArrayStyle::kBinKeys
                                                         : wire::ArrayStyle::kTextKeys);
  std::string out(reinterpret_cast<const char*>(packed.data()), packed.size());
  return dice.below(3) == 0 ? damaged_lengths(std::move(out), dice) : out;
}

// TensorFlow's: one record with another payload, its checksums right. Else nothing behind a
// checksum is ever read.
std::string damaged_records(const std::string& bytes, Dice& dice) {
  std::vector<std::string> payloads;
  for (std::size_t at = 0; at + 12 < bytes.size();) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at, sizeof size);
    if (size > bytes.size() - at - 12) return damaged_lengths(bytes, dice);
    payloads.push_back(bytes.substr(at + 12, size));
    at += 16 + size;
  }
  if (payloads.empty()) return damaged_lengths(bytes, dice);
  std::string& one = payloads[dice.below(payloads.size())];
  one = dice.below(2) == 0 ? damaged_lengths(std::move(one), dice)
                           : scene::test::mutated(std::move(one), dice.below(1u << 30));
  std::string out;
  const auto put = [&](const auto& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const std::string& payload : payloads) {
    const std::uint64_t size = payload.size();
    put(size);
    put(dataset::masked_crc32c({reinterpret_cast<const char*>(&size), sizeof size}));
    out += payload;
    put(dataset::masked_crc32c(payload));
  }
  return out;
}

}  // namespace

Form form_of(std::string_view name) {
  if (name.ends_with(".json") || name.ends_with(".jsonl")) return Form::kJson;
  if (name.ends_with(".csv")) return Form::kTable;
  if (name.find(".tfrecord") != name.npos) return Form::kRecords;
  return Form::kBytes;
}

std::string damaged(std::string bytes, Form form, std::uint64_t seed) {
  Dice dice(seed ^ 0x5bd1e995);
  if (dice.below(2) == 0) return scene::test::mutated(std::move(bytes), seed);
  switch (form) {
    case Form::kJson:
      return damaged_json(std::move(bytes), dice);
    case Form::kTable:
      return damaged_table(std::move(bytes), dice);
    case Form::kMsgpack:
      return damaged_msgpack(bytes, dice);
    case Form::kRecords:
      return damaged_records(bytes, dice);
    case Form::kBytes:
      break;
  }
  return damaged_lengths(std::move(bytes), dice);
}

}  // namespace probe::campaign
