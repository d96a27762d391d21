#include "runtime/export/parquet/thrift.h"

#include "runtime/base/check.h"

namespace probe::parquet::thrift {

void Writer::varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<char>((value & 0x7f) | 0x80));
  bytes_.push_back(static_cast<char>(value));
}

void Writer::zigzag(std::int64_t value) {
  varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

void Writer::field(int id, Kind kind) {
  PROBE_CHECK(!ids_.empty(), "a field outside of its struct");
  const int delta = id - ids_.back();
  ids_.back() = id;
  if (delta >= 1 && delta <= 15) {
    bytes_.push_back(static_cast<char>((delta << 4) | static_cast<int>(kind)));
    return;
  }
  bytes_.push_back(static_cast<char>(kind));
  zigzag(id);
}

Writer& Writer::i16(int id, std::int16_t value) {
  field(id, Kind::kI16);
  zigzag(value);
  return *this;
}
Writer& Writer::i32(int id, std::int32_t value) {
  field(id, Kind::kI32);
  zigzag(value);
  return *this;
}
Writer& Writer::i64(int id, std::int64_t value) {
  field(id, Kind::kI64);
  zigzag(value);
  return *this;
}
Writer& Writer::flag(int id, bool value) {
  field(id, value ? Kind::kTrue : Kind::kFalse);
  return *this;
}
Writer& Writer::byte(int id, std::int8_t value) {
  field(id, Kind::kByte);
  bytes_.push_back(static_cast<char>(value));
  return *this;
}
Writer& Writer::text(int id, std::string_view value) {
  field(id, Kind::kBinary);
  return element_text(value);
}
Writer& Writer::begin(int id) {
  field(id, Kind::kStruct);
  return element();
}
Writer& Writer::list(int id, Kind of, std::size_t count) {
  field(id, Kind::kList);
  const int kind = static_cast<int>(of);
  if (count < 15) {
    bytes_.push_back(static_cast<char>((count << 4) | static_cast<std::size_t>(kind)));
    return *this;
  }
  bytes_.push_back(static_cast<char>(0xf0 | kind));
  varint(count);
  return *this;
}
Writer& Writer::element_i32(std::int32_t value) {
  zigzag(value);
  return *this;
}
Writer& Writer::element_text(std::string_view value) {
  varint(value.size());
  return raw(value);
}
Writer& Writer::element() {
  ids_.push_back(0);
  return *this;
}
Writer& Writer::end() {
  PROBE_CHECK(!ids_.empty(), "no struct is open");
  ids_.pop_back();
  bytes_.push_back('\0');
  return *this;
}
Writer& Writer::raw(std::string_view bytes) {
  bytes_.append(bytes);
  return *this;
}

const Value* Value::find(int id) const {
  for (const Value& one : fields) {
    if (one.field == id) return &one;
  }
  return nullptr;
}
std::optional<std::int64_t> Value::whole_at(int id) const {
  const Value* found = find(id);
  if (found == nullptr || found->kind == Kind::kBinary || found->kind == Kind::kList ||
      found->kind == Kind::kStruct || found->kind == Kind::kDouble)
    return std::nullopt;
  return found->whole;
}
const std::string* Value::bytes_at(int id) const {
  const Value* found = find(id);
  return found != nullptr && found->kind == Kind::kBinary ? &found->bytes : nullptr;
}
const Value* Value::list_at(int id) const {
  const Value* found = find(id);
  return found != nullptr && found->kind == Kind::kList ? found : nullptr;
}
const Value* Value::struct_at(int id) const {
  const Value* found = find(id);
  return found != nullptr && found->kind == Kind::kStruct ? found : nullptr;
}

namespace {

constexpr int kMostNested = 16;

class StructReader {
 public:
  explicit StructReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool read(Value& to, Kind kind, int depth) {
    to.kind = kind;
    switch (kind) {
      case Kind::kTrue:
      case Kind::kFalse:
        to.whole = kind == Kind::kTrue;
        return true;
      case Kind::kByte:
        to.whole = static_cast<std::int8_t>(byte());
        return ok_;
      case Kind::kI16:
      case Kind::kI32:
      case Kind::kI64:
        to.whole = zigzag();
        return ok_;
      case Kind::kDouble:
        return take(8).size() == 8;
      case Kind::kBinary: {
        const auto bytes = take(varint());
        to.bytes.assign(bytes.begin(), bytes.end());
        return ok_;
      }
      case Kind::kList:
        return depth < kMostNested && list(to, depth);
      case Kind::kStruct:
        return depth < kMostNested && fields(to, depth);
    }
    return false;
  }
  std::size_t at() const { return at_; }

 private:
  bool list(Value& to, int depth) {
    const std::uint8_t head = byte();
    const std::uint64_t count = head >> 4 == 15 ? varint() : head >> 4;
    // Every element has a byte.
    if (!ok_ || count > bytes_.size() - at_) return false;
    for (std::uint64_t i = 0; i < count; ++i) {
      Kind kind = static_cast<Kind>(head & 15);
      // In a list a truth is a byte of its own.
      if (kind == Kind::kTrue || kind == Kind::kFalse) kind = Kind::kByte;
      if (!read(to.elements.emplace_back(), kind, depth + 1)) return false;
    }
    return true;
  }
  bool fields(Value& to, int depth) {
    int id = 0;
    for (;;) {
      const std::uint8_t head = byte();
      if (!ok_) return false;
      if (head == 0) return true;
      id = head >> 4 == 0 ? static_cast<int>(zigzag() & 0xffff) : id + (head >> 4);
      Value& next = to.fields.emplace_back();
      next.field = id;
      if (!read(next, static_cast<Kind>(head & 15), depth + 1)) return false;
    }
  }
  std::uint8_t byte() {
    const auto taken = take(1);
    return taken.empty() ? std::uint8_t{0} : taken[0];
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t next = byte();
      value |= static_cast<std::uint64_t>(next & 0x7f) << shift;
      if (next < 0x80) return value;
    }
    ok_ = false;
    return 0;
  }
  std::int64_t zigzag() {
    const std::uint64_t value = varint();
    return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
  }
  std::span<const std::uint8_t> take(std::uint64_t size) {
    if (!ok_ || size > bytes_.size() - at_) {
      ok_ = false;
      return {};
    }
    const auto part = bytes_.subspan(at_, static_cast<std::size_t>(size));
    at_ += part.size();
    return part;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace

std::optional<Read> read_struct(std::span<const std::uint8_t> bytes) {
  StructReader reader(bytes);
  Read out;
  if (!reader.read(out.value, Kind::kStruct, 0)) return std::nullopt;
  out.size = reader.at();
  return out;
}

}  // namespace probe::parquet::thrift
