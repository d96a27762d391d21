#include "runtime/wire/msgpack.h"

#include <msgpack.hpp>
#include <optional>
#include <string>

#include "runtime/wire/npy.h"

namespace probe::wire {
namespace {

constexpr std::size_t kDepth = 64;
// Of one list or map: a header that claims more than its message holds may cost no more than this
// at a level.
constexpr std::size_t kElements = 65536;

Failure bad_msgpack(const std::string& message) { return {Fault::kPolicy, message, ""}; }

// ---- writing ----------------------------------------------------------------------------------

struct Sink {
  Bytes bytes;
  void write(const char* data, std::size_t size) {
    bytes.insert(bytes.end(), data, data + size);  // signed to unsigned bytes, one to one
  }
};

using Packer = msgpack::packer<Sink>;

void pack_text(Packer& packer, std::string_view text) {
  packer.pack_str(static_cast<std::uint32_t>(text.size()));
  packer.pack_str_body(text.data(), static_cast<std::uint32_t>(text.size()));
}

void pack_bin(Packer& packer, const void* data, std::size_t size) {
  packer.pack_bin(static_cast<std::uint32_t>(size));
  packer.pack_bin_body(static_cast<const char*>(data), static_cast<std::uint32_t>(size));
}

void pack_key(Packer& packer, std::string_view key, ArrayStyle style) {
  if (style == ArrayStyle::kBinKeys) {
    pack_bin(packer, key.data(), key.size());
  } else {
    pack_text(packer, key);
  }
}

void pack_array(Packer& packer, const Array& array, ArrayStyle style) {
  if (style == ArrayStyle::kNpy) {
    const Bytes file = to_npy(array);
    packer.pack_map(2);
    pack_text(packer, "__ndarray_class__");
    packer.pack_true();
    pack_text(packer, "as_npy");
    pack_bin(packer, file.data(), file.size());
    return;
  }
  // Upstream's order of keys.
  packer.pack_map(4);
  pack_key(packer, "__ndarray__", style);
  packer.pack_true();
  pack_key(packer, "data", style);
  pack_bin(packer, array.bytes.data(), array.bytes.size());
  pack_key(packer, "dtype", style);
  pack_text(packer, array.dtype);
  pack_key(packer, "shape", style);
  packer.pack_array(static_cast<std::uint32_t>(array.shape.size()));
  for (const std::int64_t n : array.shape) packer.pack_int64(n);
}

void pack(Packer& packer, const Value& value, ArrayStyle style) {
  if (const auto* b = value.as<bool>()) {
    *b ? packer.pack_true() : packer.pack_false();
  } else if (const auto* i = value.as<std::int64_t>()) {
    packer.pack_int64(*i);
  } else if (const auto* d = value.as<double>()) {
    packer.pack_double(*d);
  } else if (const auto* s = value.as<std::string>()) {
    pack_text(packer, *s);
  } else if (const auto* bytes = value.as<Bytes>()) {
    pack_bin(packer, bytes->data(), bytes->size());
  } else if (const auto* array = value.as<Array>()) {
    pack_array(packer, *array, style);
  } else if (const auto* list = value.as<List>()) {
    packer.pack_array(static_cast<std::uint32_t>(list->size()));
    for (const Value& element : *list) pack(packer, element, style);
  } else if (const auto* map = value.as<Map>()) {
    packer.pack_map(static_cast<std::uint32_t>(map->size()));
    for (const auto& [key, element] : *map) {
      pack_text(packer, key);
      pack(packer, element, style);
    }
  } else {
    packer.pack_nil();
  }
}

// ---- reading ----------------------------------------------------------------------------------

std::string_view text_of(const msgpack::object& object) {
  if (object.type == msgpack::type::STR) return {object.via.str.ptr, object.via.str.size};
  if (object.type == msgpack::type::BIN) return {object.via.bin.ptr, object.via.bin.size};
  return {};
}

const msgpack::object* entry(const msgpack::object_map& map, std::string_view key) {
  for (std::uint32_t i = 0; i < map.size; ++i) {
    if (text_of(map.ptr[i].key) == key) return &map.ptr[i].val;
  }
  return nullptr;
}

Bytes bytes_of(const msgpack::object& object) {
  const std::string_view view = text_of(object);
  return {view.begin(), view.end()};
}

Result<Value> read_marked(const msgpack::object_map& map) {
  if (const auto* file = entry(map, "as_npy")) {
    PROBE_ASSIGN(Array array, from_npy(bytes_of(*file)));
    return Value(std::move(array));
  }
  const auto* data = entry(map, "data");
  const auto* dtype = entry(map, "dtype");
  const auto* shape = entry(map, "shape");
  if (data == nullptr || dtype == nullptr || shape == nullptr ||
      shape->type != msgpack::type::ARRAY) {
    return bad_msgpack("an array needs `data`, `dtype` and a list `shape`");
  }
  Array array{std::string(text_of(*dtype)), {}, bytes_of(*data)};
  if (shape->via.array.size > kMostDimensions)
    return bad_msgpack("an array's `shape` has too many sizes");
  for (std::uint32_t i = 0; i < shape->via.array.size; ++i) {
    const msgpack::object& n = shape->via.array.ptr[i];
    if (n.type != msgpack::type::POSITIVE_INTEGER || n.via.u64 > (std::uint64_t{1} << 40)) {
      return bad_msgpack("an array's `shape` is not made of sizes");
    }
    array.shape.push_back(static_cast<std::int64_t>(n.via.u64));
  }
  PROBE_TRY(check_fit(array));
  return Value(std::move(array));
}

Result<Value> read(const msgpack::object& object);

Result<Value> read_map(const msgpack::object_map& map) {
  if (entry(map, "__ndarray__") != nullptr || entry(map, "__ndarray_class__") != nullptr) {
    return read_marked(map);
  }
  if (entry(map, "__npgeneric__") != nullptr) {
    const auto* number = entry(map, "data");
    if (number == nullptr) return bad_msgpack("a numpy scalar needs `data`");
    return read(*number);
  }
  Map entries;
  entries.reserve(map.size);
  for (std::uint32_t i = 0; i < map.size; ++i) {
    const auto type = map.ptr[i].key.type;
    if (type != msgpack::type::STR && type != msgpack::type::BIN) {
      return bad_msgpack("a key of a map is not a text");
    }
    PROBE_ASSIGN(Value value, read(map.ptr[i].val));
    entries.emplace_back(std::string(text_of(map.ptr[i].key)), std::move(value));
  }
  return Value(std::move(entries));
}

Result<Value> read(const msgpack::object& object) {
  switch (object.type) {
    case msgpack::type::NIL:
      return Value();
    case msgpack::type::BOOLEAN:
      return Value(object.via.boolean);
    case msgpack::type::POSITIVE_INTEGER:
      if (object.via.u64 > INT64_MAX) return Value(static_cast<double>(object.via.u64));
      return Value(static_cast<std::int64_t>(object.via.u64));
    case msgpack::type::NEGATIVE_INTEGER:
      return Value(object.via.i64);
    case msgpack::type::FLOAT32:
    case msgpack::type::FLOAT64:
      return Value(object.via.f64);
    case msgpack::type::STR:
      return Value(std::string(text_of(object)));
    case msgpack::type::BIN:
      return Value(bytes_of(object));
    case msgpack::type::ARRAY: {
      List list;
      list.reserve(object.via.array.size);
      for (std::uint32_t i = 0; i < object.via.array.size; ++i) {
        PROBE_ASSIGN(Value value, read(object.via.array.ptr[i]));
        list.push_back(std::move(value));
      }
      return Value(std::move(list));
    }
    case msgpack::type::MAP:
      return read_map(object.via.map);
    default:
      return bad_msgpack("an extension type is not read");
  }
}

// How many values a message has, at most kMostValues + 1: each takes a byte there and a hundred
// here. Of what is cut off or no message the unpacker says so.
std::size_t count_values(std::span<const std::uint8_t> bytes) {
  std::size_t values = 0;
  for (std::size_t at = 0; at < bytes.size() && values <= kMostValues; ++values) {
    const std::uint8_t mark = bytes[at++];
    // The bytes of a number, or of the size of what follows, by the mark's last bits.
    const auto size_of = [&](std::size_t size_bytes) {
      std::size_t size = 0;
      for (std::size_t i = 0; i < size_bytes && at < bytes.size(); ++i)
        size = size << 8 | bytes[at++];
      return size;
    };
    std::size_t behind = 0;
    if (mark >= 0xa0 && mark <= 0xbf) behind = mark & 0x1f;                               // text
    if (mark >= 0xc4 && mark <= 0xc6) behind = size_of(std::size_t{1} << (mark - 0xc4));  // bin
    if (mark >= 0xc7 && mark <= 0xc9) behind = 1 + size_of(std::size_t{1} << (mark - 0xc7));
    if (mark == 0xca) behind = 4;
    if (mark == 0xcb) behind = 8;
    if (mark >= 0xcc && mark <= 0xcf) behind = std::size_t{1} << (mark - 0xcc);
    if (mark >= 0xd0 && mark <= 0xd3) behind = std::size_t{1} << (mark - 0xd0);
    if (mark >= 0xd4 && mark <= 0xd8) behind = 1 + (std::size_t{1} << (mark - 0xd4));
    if (mark >= 0xd9 && mark <= 0xdb) behind = size_of(std::size_t{1} << (mark - 0xd9));
    if (mark == 0xdc || mark == 0xde) behind = 2;  // the count of a list or map, whose
    if (mark == 0xdd || mark == 0xdf) behind = 4;  // values stand behind it
    if (behind > bytes.size() - at) break;
    at += behind;
  }
  return values;
}

}  // namespace

Bytes to_msgpack(const Value& value, ArrayStyle style) {
  Sink sink;
  Packer packer(sink);
  pack(packer, value, style);
  return std::move(sink.bytes);
}

Result<Value> from_msgpack(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return bad_msgpack("not a MessagePack message: it is empty");
  if (count_values(bytes) > kMostValues) {
    return bad_msgpack("a MessagePack message of more than " + std::to_string(kMostValues) +
                       " values");
  }
  const msgpack::unpack_limit limit(kElements, kElements, bytes.size(), bytes.size(), bytes.size(),
                                    kDepth);
  try {
    std::size_t offset = 0;
    const msgpack::object_handle handle = msgpack::unpack(
        reinterpret_cast<const char*>(bytes.data()), bytes.size(), offset,
        [](auto, auto, auto) { return true; }, nullptr, limit);
    if (offset != bytes.size()) {
      return bad_msgpack("not one MessagePack message: " + std::to_string(bytes.size() - offset) +
                         " bytes follow it");
    }
    return read(handle.get());
  } catch (const std::exception& error) {
    return bad_msgpack(std::string("not a MessagePack message: ") + error.what());
  }
}

}  // namespace probe::wire
