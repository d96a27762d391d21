#include "runtime/wire/pickle.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "runtime/base/printable.h"
#include "runtime/wire/pickle_arrays.h"

namespace probe::wire {
namespace {

using Kind = PickleNode::Kind;

enum class Op : std::uint8_t {
#define PICKLE_OPCODE(name, byte, is_read) k##name = byte,
#include "runtime/wire/pickle_opcodes.def"
#undef PICKLE_OPCODE
};

struct OpRow {
  std::string_view name;
  std::uint8_t byte;
  bool is_read;
};
constexpr OpRow kOps[] = {
#define PICKLE_OPCODE(name, byte, is_read) {#name, byte, is_read},
#include "runtime/wire/pickle_opcodes.def"
#undef PICKLE_OPCODE
};

constexpr std::size_t kMostMarks = 64;
constexpr std::size_t kLongestShown = 80;
constexpr std::uint8_t kNewestProtocol = 5;
constexpr std::uint8_t kWrittenProtocol = 4;

class PickleReader {
 public:
  PickleReader(std::span<const std::uint8_t> bytes, std::span<const std::string_view> known,
               std::size_t most_values)
      : bytes_(bytes), known_(known), most_(most_values) {}

  Result<Pickle> read() {
    while (true) {
      begin_ = at_;
      PROBE_ASSIGN(const std::uint64_t byte, number(1));
      PROBE_TRY(step(static_cast<std::uint8_t>(byte)));
      if (pickle_.nodes.size() > most_)
        return wrong("more than " + std::to_string(most_) + " values");
      if (!is_over_) continue;
      if (stack_.size() != 1 || !marks_.empty())
        return wrong("the pickle ends with " + std::to_string(stack_.size()) + " values, not one");
      pickle_.root = stack_.front();
      pickle_.size = at_;
      return std::move(pickle_);
    }
  }

 private:
  Failure wrong(const std::string& what) const {
    return {Fault::kPolicy, "byte " + std::to_string(begin_) + " of a pickle: " + what, ""};
  }

  Status step(std::uint8_t byte) {
    const auto row = std::ranges::find(kOps, byte, &OpRow::byte);
    if (row == std::end(kOps)) return wrong("no opcode is " + std::to_string(byte));
    if (!row->is_read) return wrong("opcode " + std::string(row->name) + " is not read");
    switch (static_cast<Op>(byte)) {
      case Op::kPROTO: {
        PROBE_ASSIGN(const std::uint64_t version, number(1));
        if (version > kNewestProtocol) return wrong("protocol " + std::to_string(version));
        return {};
      }
      case Op::kFRAME:
        return number(8).ok() ? Status() : Status(too_short());
      case Op::kSTOP:
        is_over_ = true;
        return {};
      case Op::kMARK:
        if (marks_.size() >= kMostMarks)
          return wrong("marks more than " + std::to_string(kMostMarks) + " deep");
        marks_.push_back(stack_.size());
        return {};
      case Op::kNONE:
        return push({});
      case Op::kNEWTRUE:
        return push({.kind = Kind::kBool, .integer = 1, .number = 0, .text = {}, .items = {}});
      case Op::kNEWFALSE:
        return push({.kind = Kind::kBool, .integer = 0, .number = 0, .text = {}, .items = {}});
      case Op::kBININT: {
        PROBE_ASSIGN(const std::uint64_t value, number(4));
        return push_integer(static_cast<std::int32_t>(static_cast<std::uint32_t>(value)));
      }
      case Op::kBININT1:
        return push_number(1);
      case Op::kBININT2:
        return push_number(2);
      case Op::kLONG1:
        return push_long();
      case Op::kBINFLOAT: {
        PROBE_ASSIGN(const std::string_view raw, part(8));
        std::uint64_t bits = 0;
        for (const char c : raw) bits = bits << 8 | static_cast<std::uint8_t>(c);
        return push({.kind = Kind::kFloat,
                     .integer = 0,
                     .number = std::bit_cast<double>(bits),
                     .text = {},
                     .items = {}});
      }
      case Op::kSHORT_BINUNICODE:
        return push_part(Kind::kText, 1);
      case Op::kBINUNICODE:
        return push_part(Kind::kText, 4);
      case Op::kSHORT_BINBYTES:
        return push_part(Kind::kBytes, 1);
      case Op::kBINBYTES:
        return push_part(Kind::kBytes, 4);
      case Op::kBINBYTES8:
      case Op::kBYTEARRAY8:
        return push_part(Kind::kBytes, 8);
      case Op::kEMPTY_LIST:
        return push_items(Kind::kList, {});
      case Op::kEMPTY_DICT:
        return push_items(Kind::kDict, {});
      case Op::kEMPTY_TUPLE:
        return push_items(Kind::kTuple, {});
      case Op::kTUPLE: {
        PROBE_ASSIGN(auto items, taken_to_mark());
        return push_items(Kind::kTuple, std::move(items));
      }
      case Op::kTUPLE1:
        return push_tuple(1);
      case Op::kTUPLE2:
        return push_tuple(2);
      case Op::kTUPLE3:
        return push_tuple(3);
      case Op::kAPPEND:
        return add(Kind::kList, taken(1));
      case Op::kAPPENDS:
        return add(Kind::kList, taken_to_mark());
      case Op::kSETITEM:
        return add(Kind::kDict, taken(2));
      case Op::kSETITEMS:
        return add(Kind::kDict, taken_to_mark());
      case Op::kGLOBAL: {
        PROBE_ASSIGN(const std::string_view module, line());
        PROBE_ASSIGN(const std::string_view name, line());
        return push_global(module, name);
      }
      case Op::kSTACK_GLOBAL: {
        PROBE_ASSIGN(const auto names, taken(2));
        const PickleNode &module = pickle_.at(names[0]), &name = pickle_.at(names[1]);
        if (module.kind != Kind::kText || name.kind != Kind::kText)
          return wrong("a global whose name is no text");
        return push_global(module.text, name.text);
      }
      case Op::kREDUCE:
      case Op::kNEWOBJ: {
        PROBE_ASSIGN(auto items, taken(2));
        if (pickle_.at(items[0]).kind != Kind::kGlobal)
          return wrong("a call of " + describe(pickle_, pickle_.at(items[0])));
        if (pickle_.at(items[1]).kind != Kind::kTuple)
          return wrong("a call with " + describe(pickle_, pickle_.at(items[1])));
        return push_items(Kind::kCall, std::move(items));
      }
      case Op::kBUILD: {
        PROBE_ASSIGN(const auto state, taken(1));
        PROBE_ASSIGN(const std::uint32_t object, last());
        if (pickle_.at(object).kind != Kind::kCall || pickle_.at(object).items.size() != 2)
          return wrong("a state for " + describe(pickle_, pickle_.at(object)));
        pickle_.nodes[object].items.push_back(state[0]);
        return {};
      }
      case Op::kBINPERSID: {
        PROBE_ASSIGN(auto items, taken(1));
        return push_items(Kind::kOutside, std::move(items));
      }
      case Op::kMEMOIZE:
        return keep(memo_.size());
      case Op::kBINPUT:
        return keep_at(1);
      case Op::kLONG_BINPUT:
        return keep_at(4);
      case Op::kBINGET:
        return recall(1);
      case Op::kLONG_BINGET:
        return recall(4);
      default:
        return wrong("opcode " + std::string(row->name) + " is not read");
    }
  }

  Failure too_short() const { return wrong("it ends in the middle"); }

  Result<std::string_view> part(std::uint64_t size) {
    if (size > bytes_.size() - at_) return too_short();
    const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
    at_ += size;
    return std::string_view(begin, size);
  }
  // Of `count` bytes, the lowest first.
  Result<std::uint64_t> number(std::size_t count) {
    PROBE_ASSIGN(const std::string_view raw, part(count));
    std::uint64_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(raw[i]);
    return value;
  }
  Result<std::string_view> line() {
    const std::string_view rest(reinterpret_cast<const char*>(bytes_.data()) + at_,
                                bytes_.size() - at_);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) return too_short();
    at_ += end + 1;
    return rest.substr(0, end);
  }

  Status push(PickleNode node) {
    stack_.push_back(static_cast<std::uint32_t>(pickle_.nodes.size()));
    pickle_.nodes.push_back(std::move(node));
    return {};
  }
  Status push_integer(std::int64_t value) {
    return push({.kind = Kind::kInt, .integer = value, .number = 0, .text = {}, .items = {}});
  }
  Status push_number(std::size_t count) {
    PROBE_ASSIGN(const std::uint64_t value, number(count));
    return push_integer(static_cast<std::int64_t>(value));
  }
  Status push_long() {
    PROBE_ASSIGN(const std::uint64_t count, number(1));
    PROBE_ASSIGN(const std::string_view raw, part(count));
    if (count > 8)
      return push({.kind = Kind::kLong, .integer = 0, .number = 0, .text = raw, .items = {}});
    const bool is_negative = count > 0 && (static_cast<std::uint8_t>(raw.back()) & 0x80) != 0;
    std::uint64_t value = is_negative ? ~std::uint64_t{0} : 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(raw[i]);
    return push_integer(static_cast<std::int64_t>(value));
  }
  Status push_part(Kind kind, std::size_t size_bytes) {
    PROBE_ASSIGN(const std::uint64_t size, number(size_bytes));
    PROBE_ASSIGN(const std::string_view text, part(size));
    return push({.kind = kind, .integer = 0, .number = 0, .text = text, .items = {}});
  }
  Status push_items(Kind kind, std::vector<std::uint32_t> items) {
    return push({.kind = kind, .integer = 0, .number = 0, .text = {}, .items = std::move(items)});
  }
  Status push_tuple(std::size_t count) {
    PROBE_ASSIGN(auto items, taken(count));
    return push_items(Kind::kTuple, std::move(items));
  }
  Status push_global(std::string_view module, std::string_view name) {
    const std::string wanted = std::string(module) + " " + std::string(name);
    const auto found = std::ranges::find(known_, wanted);
    if (found == known_.end())
      return wrong("the global `" + printable(wanted, kLongestShown) + "` is not read");
    return push({.kind = Kind::kGlobal, .integer = 0, .number = 0, .text = *found, .items = {}});
  }

  // What lies on the stack above the last mark.
  std::size_t floor() const { return marks_.empty() ? 0 : marks_.back(); }
  Failure missing() const { return wrong("it takes values that are not there"); }

  Result<std::vector<std::uint32_t>> taken(std::size_t count) {
    if (stack_.size() - floor() < count) return missing();
    std::vector<std::uint32_t> items(stack_.end() - static_cast<std::ptrdiff_t>(count),
                                     stack_.end());
    stack_.resize(stack_.size() - count);
    return items;
  }
  Result<std::vector<std::uint32_t>> taken_to_mark() {
    if (marks_.empty()) return wrong("there is no mark");
    auto items = taken(stack_.size() - marks_.back());
    marks_.pop_back();
    return items;
  }
  Result<std::uint32_t> last() const {
    if (stack_.size() <= floor()) return missing();
    return stack_.back();
  }
  Status add(Kind kind, Result<std::vector<std::uint32_t>> items) {
    if (!items) return items.failure();
    PROBE_ASSIGN(const std::uint32_t container, last());
    PickleNode& node = pickle_.nodes[container];
    if (node.kind != kind) return wrong("items for " + describe(pickle_, node));
    if (kind == Kind::kDict && items->size() % 2 != 0) return wrong("a key without a value");
    node.items.insert(node.items.end(), items->begin(), items->end());
    return {};
  }

  Status keep(std::size_t index) {
    PROBE_ASSIGN(const std::uint32_t node, last());
    if (index >= most_) return wrong("value " + std::to_string(index) + " is kept");
    if (memo_.size() <= index) memo_.resize(index + 1, kNothing);
    memo_[index] = node;
    return {};
  }
  Status keep_at(std::size_t count) {
    PROBE_ASSIGN(const std::uint64_t index, number(count));
    return keep(index);
  }
  Status recall(std::size_t count) {
    PROBE_ASSIGN(const std::uint64_t index, number(count));
    if (index >= memo_.size() || memo_[index] == kNothing)
      return wrong("value " + std::to_string(index) + " was not kept");
    stack_.push_back(memo_[index]);
    return {};
  }

  static constexpr std::uint32_t kNothing = ~std::uint32_t{0};

  std::span<const std::uint8_t> bytes_;
  std::span<const std::string_view> known_;
  std::size_t most_;
  std::size_t at_ = 0, begin_ = 0;  // the next byte; the present opcode's
  bool is_over_ = false;
  Pickle pickle_;
  std::vector<std::uint32_t> stack_, memo_;
  std::vector<std::size_t> marks_;
};

}  // namespace

const PickleNode* Pickle::item(const PickleNode& node, std::size_t index) const {
  return index < node.items.size() ? &nodes[node.items[index]] : nullptr;
}

const PickleNode* Pickle::find(const PickleNode& dict, std::string_view key) const {
  if (dict.kind != Kind::kDict) return nullptr;
  for (std::size_t i = 0; i + 1 < dict.items.size(); i += 2) {
    const PickleNode& name = nodes[dict.items[i]];
    if (name.kind == Kind::kText && name.text == key) return &nodes[dict.items[i + 1]];
  }
  return nullptr;
}

Result<Pickle> read_pickle(std::span<const std::uint8_t> bytes,
                           std::span<const std::string_view> known, std::size_t most_values) {
  return PickleReader(bytes, known, most_values).read();
}

std::string describe(const Pickle& pickle, const PickleNode& node) {
  switch (node.kind) {
    case Kind::kNone:
      return "None";
    case Kind::kBool:
      return node.integer != 0 ? "True" : "False";
    case Kind::kInt:
      return "the number " + std::to_string(node.integer);
    case Kind::kFloat:
      return "the number " + std::to_string(node.number);
    case Kind::kText:
      return "the text \"" + printable(node.text, kLongestShown) + "\"";
    case Kind::kBytes:
      return std::to_string(node.text.size()) + " bytes";
    case Kind::kLong:
      return "a number of " + std::to_string(node.text.size()) + " bytes";
    case Kind::kList:
      return "a list of " + std::to_string(node.items.size());
    case Kind::kTuple:
      return "a tuple of " + std::to_string(node.items.size());
    case Kind::kDict:
      return "a dict of " + std::to_string(node.items.size() / 2);
    case Kind::kGlobal:
      return "`" + std::string(node.text) + "`";
    case Kind::kCall:
      return "one of `" + std::string(pickle.at(node.items[0]).text) + "`";
    case Kind::kOutside:
      break;
  }
  return "a reference";
}

PickleWriter::PickleWriter() {
  opcode(0x80);
  opcode(kWrittenProtocol);
}

void PickleWriter::size(std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i, value >>= 8)
    bytes_.push_back(static_cast<std::uint8_t>(value & 0xff));
}

void PickleWriter::none() { opcode(static_cast<std::uint8_t>(Op::kNONE)); }
void PickleWriter::boolean(bool value) {
  opcode(static_cast<std::uint8_t>(value ? Op::kNEWTRUE : Op::kNEWFALSE));
}
void PickleWriter::integer(std::int64_t value) {
  opcode(static_cast<std::uint8_t>(Op::kLONG1));
  opcode(8);
  size(static_cast<std::uint64_t>(value), 8);
}
void PickleWriter::number(double value) {
  opcode(static_cast<std::uint8_t>(Op::kBINFLOAT));
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int shift = 56; shift >= 0; shift -= 8)
    bytes_.push_back(static_cast<std::uint8_t>(bits >> shift & 0xff));
}
void PickleWriter::text(std::string_view value) {
  opcode(static_cast<std::uint8_t>(Op::kBINUNICODE));
  size(value.size(), 4);
  bytes_.insert(bytes_.end(), value.begin(), value.end());
}
void PickleWriter::bytes(std::span<const std::uint8_t> value) {
  opcode(static_cast<std::uint8_t>(Op::kBINBYTES));
  size(value.size(), 4);
  bytes_.insert(bytes_.end(), value.begin(), value.end());
}
void PickleWriter::begin_list() {
  opcode(static_cast<std::uint8_t>(Op::kEMPTY_LIST));
  opcode(static_cast<std::uint8_t>(Op::kMARK));
}
void PickleWriter::end_list() { opcode(static_cast<std::uint8_t>(Op::kAPPENDS)); }
void PickleWriter::begin_tuple() { opcode(static_cast<std::uint8_t>(Op::kMARK)); }
void PickleWriter::end_tuple() { opcode(static_cast<std::uint8_t>(Op::kTUPLE)); }
void PickleWriter::begin_dict() {
  opcode(static_cast<std::uint8_t>(Op::kEMPTY_DICT));
  opcode(static_cast<std::uint8_t>(Op::kMARK));
}
void PickleWriter::end_dict() { opcode(static_cast<std::uint8_t>(Op::kSETITEMS)); }
void PickleWriter::global(std::string_view name) {
  const std::size_t cut = name.find(' ');
  text(name.substr(0, cut));
  text(name.substr(cut + 1));
  opcode(static_cast<std::uint8_t>(Op::kSTACK_GLOBAL));
}
void PickleWriter::call() { opcode(static_cast<std::uint8_t>(Op::kREDUCE)); }
void PickleWriter::make() { opcode(static_cast<std::uint8_t>(Op::kNEWOBJ)); }
void PickleWriter::outside() { opcode(static_cast<std::uint8_t>(Op::kBINPERSID)); }
void PickleWriter::set_state() { opcode(static_cast<std::uint8_t>(Op::kBUILD)); }

void PickleWriter::value(const Value& value) {
  if (const auto* flag = value.as<bool>()) return boolean(*flag);
  if (const auto* whole = value.as<std::int64_t>()) return integer(*whole);
  if (const auto* real = value.as<double>()) return number(*real);
  if (const auto* words = value.as<std::string>()) return text(*words);
  if (const auto* raw = value.as<Bytes>()) return bytes(*raw);
  if (const auto* array = value.as<Array>()) return write_numpy(*array, *this);
  if (const auto* list = value.as<List>()) {
    begin_list();
    for (const Value& item : *list) this->value(item);
    return end_list();
  }
  if (const auto* map = value.as<Map>()) {
    begin_dict();
    for (const auto& [key, item] : *map) {
      text(key);
      this->value(item);
    }
    return end_dict();
  }
  none();
}

Bytes PickleWriter::finish() {
  opcode(static_cast<std::uint8_t>(Op::kSTOP));
  return std::move(bytes_);
}

}  // namespace probe::wire
