// Python's pickles as data. A pickle is a program that builds an object; this reader follows the
// opcodes that build values and runs nothing: a class or a function is a name, and only those names
// that the caller knows are read; a call is kept as what would have been called. Everything else is
// refused by its name.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/wire/value.h"

namespace probe::wire {

struct PickleNode {
  enum class Kind : std::uint8_t {
    kNone,
    kBool,
    kInt,
    kFloat,
    kText,
    kBytes,
    kLong,  // a whole number of more than 64 bits: its bytes, the lowest first
    kList,
    kTuple,
    kDict,    // key, value, key, value ...
    kGlobal,  // a known name
    kCall,    // what would be called, its arguments, and the state that would be set, if any
    kOutside  // what stands elsewhere, by the identity that the item is
  };
  Kind kind = Kind::kNone;
  std::int64_t integer = 0;  // kBool, kInt
  double number = 0;         // kFloat
  // kText and kBytes within the pickle's bytes; kGlobal as the caller knows it.
  std::string_view text;
  std::vector<std::uint32_t> items;  // of Pickle::nodes
};

// Nodes may share items, and a list may hold itself: whoever follows them knows how deep to go.
struct Pickle {
  std::vector<PickleNode> nodes;
  std::uint32_t root = 0;
  std::size_t size = 0;  // bytes that it takes; others may follow

  const PickleNode& at(std::uint32_t node) const { return nodes[node]; }
  const PickleNode& top() const { return nodes[root]; }
  // Item `index`, or nothing where there are fewer.
  const PickleNode* item(const PickleNode& node, std::size_t index) const;
  // The value of a text key of a dict, or nothing.
  const PickleNode* find(const PickleNode& dict, std::string_view key) const;
};

// The first pickle in `bytes`, which must outlive it; `known` are names of globals, "module name",
// which also must. Fails (kPolicy) naming the byte and what stands there: an opcode or a name that
// is not read, an end too early, an item where none is, more than `most_values` nodes, marks more
// than 64 deep.
Result<Pickle> read_pickle(std::span<const std::uint8_t> bytes,
                           std::span<const std::string_view> known,
                           std::size_t most_values = kMostValues);

// "a list of 3", "call of numpy dtype": for messages about what was expected.
std::string describe(const Pickle& pickle, const PickleNode& node);

// Writes one pickle of protocol 4. A begun container holds what is written until it ends.
class PickleWriter {
 public:
  PickleWriter();
  void none();
  void boolean(bool value);
  void integer(std::int64_t value);
  void number(double value);
  void text(std::string_view value);
  void bytes(std::span<const std::uint8_t> value);
  void begin_list();
  void end_list();
  void begin_tuple();
  void end_tuple();
  void begin_dict();  // then key, value, key, value ...
  void end_dict();
  void global(std::string_view name);  // "module name"
  void call();                         // takes what is to be called and a tuple
  void make();                         // takes a class and a tuple
  void set_state();                    // takes an object and its state
  void outside();                      // takes the identity of what stands elsewhere
  // Texts, numbers, lists, maps; arrays as numpy's.
  void value(const Value& value);
  Bytes finish();

 private:
  void opcode(std::uint8_t byte) { bytes_.push_back(byte); }
  void size(std::uint64_t value, int count);
  Bytes bytes_;
};

}  // namespace probe::wire
