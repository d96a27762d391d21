#include "runtime/servers/protocols/lerobot_messages.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "runtime/wire/pickle.h"
#include "runtime/wire/pickle_arrays.h"

namespace probe::servers::lerobot {
namespace {

using wire::Pickle;
using wire::PickleNode;
using NodeKind = wire::PickleNode::Kind;

constexpr std::string_view kConfigClass = "lerobot.async_inference.helpers RemotePolicyConfig";
constexpr std::string_view kObservationClass = "lerobot.async_inference.helpers TimedObservation";
constexpr std::string_view kActionClass = "lerobot.async_inference.helpers TimedAction";

constexpr std::size_t kPartSize = std::size_t{2} << 20;  // transport/utils.py
constexpr std::size_t kLastPartSize = 1024;
constexpr std::size_t kMostTimedActions = 1000;
constexpr std::size_t kMostPictureBytes = std::size_t{256} << 20;
constexpr int kDeepestValue = 8;

// transport/services.proto, TransferState.
enum Transfer : std::uint8_t { kTransferBegin = 1, kTransferMiddle = 2, kTransferEnd = 3 };

std::span<const std::string_view> known_globals() {
  static const std::vector<std::string_view> all = [] {
    std::vector<std::string_view> names(wire::array_globals().begin(), wire::array_globals().end());
    names.insert(names.end(), {kConfigClass, kObservationClass, kActionClass});
    return names;
  }();
  return all;
}

// ---- protobuf: fields of varints and bytes
// -------------------------------------------------------

constexpr std::uint8_t kBytesField = 2;  // wire type

void put_varint(std::uint64_t value, wire::Bytes* bytes) {
  for (; value > 0x7f; value >>= 7) bytes->push_back(static_cast<std::uint8_t>(value | 0x80));
  bytes->push_back(static_cast<std::uint8_t>(value));
}

void put_bytes(int field, std::span<const std::uint8_t> value, wire::Bytes* bytes) {
  put_varint(static_cast<std::uint64_t>(field) << 3 | kBytesField, bytes);
  put_varint(value.size(), bytes);
  bytes->insert(bytes->end(), value.begin(), value.end());
}

std::optional<std::uint64_t> take_varint(std::span<const std::uint8_t>* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes->size() && i < 10; ++i) {
    value |= static_cast<std::uint64_t>((*bytes)[i] & 0x7f) << (7 * i);
    if (((*bytes)[i] & 0x80) != 0) continue;
    *bytes = bytes->subspan(i + 1);
    return value;
  }
  return std::nullopt;
}

// The bytes of `field` in a message; none are an empty text, as protobuf has it.
Result<std::span<const std::uint8_t>> bytes_field(std::span<const std::uint8_t> message,
                                                  int field) {
  std::span<const std::uint8_t> found;
  while (!message.empty()) {
    const auto key = take_varint(&message);
    if (!key) return bad("not a message of protobuf");
    const auto size = take_varint(&message);
    if (!size) return bad("not a message of protobuf");
    if ((*key & 7) == 0) continue;  // a number, which the size was
    if ((*key & 7) != kBytesField || *size > message.size())
      return bad("not a message of protobuf");
    if (*key >> 3 == static_cast<std::uint64_t>(field)) found = message.first(*size);
    message = message.subspan(*size);
  }
  return found;
}

// ---- dataclasses
// ---------------------------------------------------------------------------------

// An object without arguments whose state are its fields.
void begin_object(std::string_view name, wire::PickleWriter& writer) {
  writer.global(name);
  writer.begin_tuple();
  writer.end_tuple();
  writer.make();
  writer.begin_dict();
}
void end_object(wire::PickleWriter& writer) {
  writer.end_dict();
  writer.set_state();
}

void put_field(std::string_view name, const wire::Value& value, wire::PickleWriter& writer) {
  writer.text(name);
  writer.value(value);
}

// The fields of an object of class `name`.
Result<const PickleNode*> fields_of(const Pickle& pickle, const PickleNode& node,
                                    std::string_view name) {
  const PickleNode* state = pickle.item(node, 2);
  if (node.kind != NodeKind::kCall || pickle.at(node.items[0]).text != name || state == nullptr ||
      state->kind != NodeKind::kDict) {
    return bad("expected a `" + std::string(name) + "`, got " + describe(pickle, node));
  }
  return state;
}

Failure no_field(const Pickle& pickle, const char* name, const char* wanted,
                 const PickleNode* found) {
  return bad(std::string("`") + name + "`: expected " + wanted + ", got " +
             (found == nullptr ? std::string("nothing") : describe(pickle, *found)));
}

Result<std::int64_t> whole_field(const Pickle& pickle, const PickleNode& fields, const char* name) {
  const PickleNode* found = pickle.find(fields, name);
  if (found == nullptr || found->kind != NodeKind::kInt)
    return no_field(pickle, name, "a whole number", found);
  return found->integer;
}

Result<double> number_field(const Pickle& pickle, const PickleNode& fields, const char* name) {
  const PickleNode* found = pickle.find(fields, name);
  if (found != nullptr && found->kind == NodeKind::kFloat) return found->number;
  if (found != nullptr && found->kind == NodeKind::kInt) return static_cast<double>(found->integer);
  return no_field(pickle, name, "a number", found);
}

Result<std::string> text_field(const Pickle& pickle, const PickleNode& fields, const char* name) {
  const PickleNode* found = pickle.find(fields, name);
  if (found == nullptr || found->kind != NodeKind::kText)
    return no_field(pickle, name, "a text", found);
  return std::string(found->text);
}

// What is left to be read of an observation: its values may be one that is named many times.
struct Budget {
  std::size_t values = 10'000;  // far more than a robot has
  std::size_t bytes = kMostPictureBytes;
};

// Plain data and arrays, at most `depth` deep.
Result<wire::Value> value_of(const Pickle& pickle, const PickleNode& node, int depth,
                             Budget* left) {
  if (depth == 0 || left->values == 0) return bad("more values, or deeper ones, than are read");
  --left->values;
  switch (node.kind) {
    case NodeKind::kNone:
      return wire::Value();
    case NodeKind::kBool:
      return wire::Value(node.integer != 0);
    case NodeKind::kInt:
      return wire::Value(node.integer);
    case NodeKind::kFloat:
      return wire::Value(node.number);
    case NodeKind::kText:
      return wire::Value(std::string(node.text));
    case NodeKind::kList:
    case NodeKind::kTuple: {
      wire::List list;
      for (const std::uint32_t item : node.items) {
        PROBE_ASSIGN(wire::Value value, value_of(pickle, pickle.at(item), depth - 1, left));
        list.push_back(std::move(value));
      }
      return wire::Value(std::move(list));
    }
    case NodeKind::kDict: {
      wire::Map map;
      for (std::size_t i = 0; i + 1 < node.items.size(); i += 2) {
        const PickleNode& key = pickle.at(node.items[i]);
        if (key.kind != NodeKind::kText) return bad("a key that is " + describe(pickle, key));
        PROBE_ASSIGN(wire::Value value,
                     value_of(pickle, pickle.at(node.items[i + 1]), depth - 1, left));
        map.emplace_back(std::string(key.text), std::move(value));
      }
      return wire::Value(std::move(map));
    }
    default: {
      PROBE_ASSIGN(wire::Array array, wire::read_array(pickle, node, left->bytes));
      left->bytes -= std::min(left->bytes, array.bytes.size());
      return wire::Value(std::move(array));
    }
  }
}

Result<wire::Map> map_field(const Pickle& pickle, const PickleNode& fields, const char* name) {
  const PickleNode* found = pickle.find(fields, name);
  if (found == nullptr || found->kind != NodeKind::kDict)
    return no_field(pickle, name, "a dict", found);
  Budget left;
  PROBE_ASSIGN(wire::Value value, value_of(pickle, *found, kDeepestValue, &left));
  return *value.as<wire::Map>();
}

Result<Pickle> whole_pickle(std::span<const std::uint8_t> bytes) {
  PROBE_ASSIGN(Pickle pickle, wire::read_pickle(bytes, known_globals()));
  if (pickle.size != bytes.size())
    return bad("not one pickle: " + std::to_string(bytes.size() - pickle.size) +
               " bytes follow it");
  return pickle;
}

Result<TimedAction> action_of(const Pickle& pickle, const PickleNode& node,
                              std::size_t most_bytes) {
  PROBE_ASSIGN(const PickleNode* fields, fields_of(pickle, node, kActionClass));
  TimedAction timed;
  PROBE_ASSIGN(timed.timestamp, number_field(pickle, *fields, "timestamp"));
  PROBE_ASSIGN(timed.timestep, whole_field(pickle, *fields, "timestep"));
  const PickleNode* action = pickle.find(*fields, "action");
  if (action == nullptr) return no_field(pickle, "action", "a tensor", action);
  PROBE_ASSIGN(timed.action, wire::read_array(pickle, *action, most_bytes));
  return timed;
}

}  // namespace

wire::GrpcCall ready() { return {kReady, {{}}}; }
wire::GrpcCall get_actions() { return {kGetActions, {{}}}; }

wire::GrpcCall send_policy(const PolicySetup& setup) {
  wire::PickleWriter writer;
  begin_object(kConfigClass, writer);
  put_field("policy_type", setup.type, writer);
  put_field("pretrained_name_or_path", setup.model, writer);
  put_field("lerobot_features", setup.features, writer);
  put_field("actions_per_chunk", setup.chunk, writer);
  put_field("device", setup.device, writer);
  put_field("rename_map", wire::Map{}, writer);
  end_object(writer);
  wire::Bytes message;
  put_bytes(1, writer.finish(), &message);
  return {kSendPolicy, {std::move(message)}};
}

wire::GrpcCall send_observation(const Observation& observation) {
  wire::PickleWriter writer;
  begin_object(kObservationClass, writer);
  put_field("timestamp", observation.timestamp, writer);
  put_field("timestep", observation.timestep, writer);
  put_field("observation", observation.content, writer);
  put_field("must_go", observation.must_go, writer);
  end_object(writer);
  const wire::Bytes pickle = writer.finish();
  wire::GrpcCall call{kSendObservations, {}};
  const std::size_t last = pickle.size() - std::min(pickle.size(), kLastPartSize);
  for (std::size_t begin = 0, size = 0; begin < pickle.size(); begin += size) {
    size = std::min(kPartSize, begin < last ? last - begin : pickle.size() - begin);
    const Transfer state = begin + size == pickle.size() ? kTransferEnd
                           : begin == 0                  ? kTransferBegin
                                                         : kTransferMiddle;
    wire::Bytes message = {1 << 3, state};
    put_bytes(2, std::span(pickle).subspan(begin, size), &message);
    call.messages.push_back(std::move(message));
  }
  return call;
}

wire::Bytes actions_message(const std::vector<TimedAction>& actions) {
  wire::PickleWriter writer;
  writer.begin_list();
  for (const TimedAction& timed : actions) {
    begin_object(kActionClass, writer);
    put_field("timestamp", timed.timestamp, writer);
    put_field("timestep", timed.timestep, writer);
    writer.text("action");
    wire::write_torch(timed.action, writer);
    end_object(writer);
  }
  writer.end_list();
  wire::Bytes message;
  put_bytes(1, writer.finish(), &message);
  return message;
}

Result<PolicySetup> setup_of(const wire::GrpcCall& call) {
  if (call.messages.size() != 1) return bad("expected one PolicySetup");
  PROBE_ASSIGN(const auto bytes, bytes_field(call.messages.front(), 1));
  PROBE_ASSIGN(const Pickle pickle, whole_pickle(bytes));
  PROBE_ASSIGN(const PickleNode* fields, fields_of(pickle, pickle.top(), kConfigClass));
  PolicySetup setup;
  PROBE_ASSIGN(setup.type, text_field(pickle, *fields, "policy_type"));
  PROBE_ASSIGN(setup.model, text_field(pickle, *fields, "pretrained_name_or_path"));
  PROBE_ASSIGN(setup.device, text_field(pickle, *fields, "device"));
  PROBE_ASSIGN(const std::int64_t chunk, whole_field(pickle, *fields, "actions_per_chunk"));
  setup.chunk = static_cast<int>(
      std::clamp<std::int64_t>(chunk, 1, static_cast<std::int64_t>(kMostTimedActions)));
  PROBE_ASSIGN(setup.features, map_field(pickle, *fields, "lerobot_features"));
  return setup;
}

Result<Observation> observation_of(const wire::GrpcCall& call) {
  wire::Bytes bytes;
  for (const wire::Bytes& message : call.messages) {
    PROBE_ASSIGN(const auto part, bytes_field(message, 2));
    bytes.insert(bytes.end(), part.begin(), part.end());
  }
  PROBE_ASSIGN(const Pickle pickle, whole_pickle(bytes));
  PROBE_ASSIGN(const PickleNode* fields, fields_of(pickle, pickle.top(), kObservationClass));
  Observation observation;
  PROBE_ASSIGN(observation.timestamp, number_field(pickle, *fields, "timestamp"));
  PROBE_ASSIGN(observation.timestep, whole_field(pickle, *fields, "timestep"));
  PROBE_ASSIGN(observation.content, map_field(pickle, *fields, "observation"));
  const PickleNode* must_go = pickle.find(*fields, "must_go");
  observation.must_go = must_go != nullptr && must_go->integer != 0;
  return observation;
}

Result<std::vector<TimedAction>> actions_of(const wire::Bytes& message, std::size_t most_bytes) {
  PROBE_ASSIGN(const auto bytes, bytes_field(message, 1));
  std::vector<TimedAction> actions;
  if (bytes.empty()) return actions;
  PROBE_ASSIGN(const Pickle pickle, whole_pickle(bytes));
  if (pickle.top().kind != NodeKind::kList)
    return bad("expected a list of TimedAction, got " + describe(pickle, pickle.top()));
  if (pickle.top().items.size() > kMostTimedActions) {
    return bad("expected at most " + std::to_string(kMostTimedActions) + " actions, got " +
               std::to_string(pickle.top().items.size()));
  }
  for (const std::uint32_t item : pickle.top().items) {
    PROBE_ASSIGN(TimedAction action, action_of(pickle, pickle.at(item), most_bytes));
    actions.push_back(std::move(action));
  }
  return actions;
}

}  // namespace probe::servers::lerobot
