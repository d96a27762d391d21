#include "runtime/wire/pickle_arrays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>

#include "runtime/base/printable.h"
#include "runtime/base/utf8.h"

namespace probe::wire {
namespace {

using Kind = PickleNode::Kind;
using Node = PickleNode;

constexpr std::string_view kReconstruct = "numpy.core.multiarray _reconstruct";
constexpr std::string_view kNewReconstruct = "numpy._core.multiarray _reconstruct";
constexpr std::string_view kScalar = "numpy.core.multiarray scalar";
constexpr std::string_view kNewScalar = "numpy._core.multiarray scalar";
constexpr std::string_view kFromBuffer = "numpy.core.numeric _frombuffer";
constexpr std::string_view kNewFromBuffer = "numpy._core.numeric _frombuffer";
constexpr std::string_view kNdarray = "numpy ndarray";
constexpr std::string_view kDtype = "numpy dtype";
constexpr std::string_view kRebuildTensor = "torch._utils _rebuild_tensor_v2";
constexpr std::string_view kLoadStorage = "torch.storage _load_from_bytes";
constexpr std::string_view kOrderedDict = "collections OrderedDict";
constexpr std::string_view kEncode = "_codecs encode";

struct StorageRow {
  std::string_view global;
  std::string_view dtype;  // of its elements; "bf2" is bfloat16
  std::size_t size;
};
constexpr StorageRow kStorages[] = {
    {"torch FloatStorage", "<f4", 4}, {"torch DoubleStorage", "<f8", 8},
    {"torch HalfStorage", "<f2", 2},  {"torch BFloat16Storage", "bf2", 2},
    {"torch LongStorage", "<i8", 8},  {"torch IntStorage", "<i4", 4},
    {"torch ByteStorage", "|u1", 1},  {"torch BoolStorage", "|b1", 1},
};

constexpr std::array kArrayGlobals = {
    kReconstruct,
    kNewReconstruct,
    kScalar,
    kNewScalar,
    kFromBuffer,
    kNewFromBuffer,
    kNdarray,
    kDtype,
    kRebuildTensor,
    kLoadStorage,
    kOrderedDict,
    kEncode,
    kStorages[0].global,
    kStorages[1].global,
    kStorages[2].global,
    kStorages[3].global,
    kStorages[4].global,
    kStorages[5].global,
    kStorages[6].global,
    kStorages[7].global,
};

// What a storage's bytes begin with: torch's magic number, as a pickle of protocol 2.
constexpr std::array<std::uint8_t, 15> kMagicPickle = {
    0x80, 0x02, 0x8a, 10, 0x6c, 0xfc, 0x9c, 0x46, 0xf9, 0x20, 0x6a, 0xa8, 0x50, 0x19, '.'};
constexpr std::size_t kMagicBegin = 4, kMagicSize = 10;
constexpr std::int64_t kStorageProtocol = 1001;
// Of each of a storage's pickles; the largest has about a dozen.
constexpr std::size_t kMostStorageValues = 64;
// Strides and offsets, so that their sums cannot overflow.
constexpr std::int64_t kFarthest = std::int64_t{1} << 40;

Failure no_array(const std::string& what) { return {Fault::kPolicy, what, ""}; }

bool is_call_of(const Pickle& pickle, const Node& node, std::string_view global) {
  return node.kind == Kind::kCall && pickle.at(node.items[0]).text == global;
}

std::optional<std::int64_t> whole(const Node* node) {
  if (node == nullptr || node->kind != Kind::kInt) return std::nullopt;
  return node->integer;
}

// A tuple of whole numbers from 0 to kFarthest.
std::optional<std::vector<std::int64_t>> whole_tuple(const Pickle& pickle, const Node* node) {
  if (node == nullptr || node->kind != Kind::kTuple || node->items.size() > kMostDimensions)
    return std::nullopt;
  std::vector<std::int64_t> numbers;
  for (const std::uint32_t item : node->items) {
    const auto number = whole(&pickle.at(item));
    if (!number || *number < 0 || *number > kFarthest) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

// The number of elements of a shape, or nothing where that is more than `most`.
std::optional<std::size_t> count_of(const std::vector<std::int64_t>& shape, std::size_t most) {
  std::size_t count = 1;
  for (const std::int64_t length : shape) {
    if (length == 0) return 0;
  }
  for (const std::int64_t length : shape) {
    if (static_cast<std::size_t>(length) > most / count) return std::nullopt;
    count *= static_cast<std::size_t>(length);
  }
  return count;
}

std::size_t element_size(std::string_view dtype) {
  return static_cast<std::size_t>(dtype.back() - '0');
}

// numpy.dtype("f4", False, True), whose state says the order of bytes: "<f4".
Result<std::string> read_dtype(const Pickle& pickle, const Node* node) {
  if (node == nullptr || !is_call_of(pickle, *node, kDtype))
    return no_array("an array without a dtype");
  const Node* name = pickle.item(pickle.at(node->items[1]), 0);
  const Node* state = pickle.item(*node, 2);
  const Node* order =
      state == nullptr || state->kind != Kind::kTuple ? nullptr : pickle.item(*state, 1);
  if (name == nullptr || name->kind != Kind::kText || order == nullptr ||
      order->kind != Kind::kText) {
    return no_array("a dtype without a name or an order of bytes");
  }
  const std::string dtype = std::string(order->text) + std::string(name->text);
  for (const char* known : {"|u1", "|b1", "<i4", "<i8", "<f4", "<f8", "<f2"}) {
    if (dtype == known) return dtype;
  }
  return no_array("an array of dtype `" + printable(dtype, 20) + "`, which is not read");
}

float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16;
  const int exponent = half >> 10 & 0x1f;
  const std::uint32_t mantissa = half & 0x3ffu;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | mantissa << 13);
  if (exponent != 0)
    return std::bit_cast<float>(sign | static_cast<std::uint32_t>(exponent + 112) << 23 |
                                mantissa << 13);
  const float small = static_cast<float>(mantissa) * 0x1p-24f;
  return sign != 0 ? -small : small;
}

// Elements of two bytes as floats of four.
Array widened(const Array& array) {
  Array wide{"<f4", array.shape, Bytes(array.bytes.size() * 2)};
  for (std::size_t i = 0; i * 2 + 1 < array.bytes.size(); ++i) {
    const auto raw = static_cast<std::uint16_t>(array.bytes[2 * i] | array.bytes[2 * i + 1] << 8);
    const float value = array.dtype == "bf2"
                            ? std::bit_cast<float>(static_cast<std::uint32_t>(raw) << 16)
                            : half_to_float(raw);
    std::memcpy(&wide.bytes[4 * i], &value, 4);
  }
  return wide;
}

Result<Array> finished(Array array) {
  return array.dtype == "bf2" || array.dtype == "<f2" ? widened(array) : std::move(array);
}

// Elements of `raw` in C order, or in Fortran's, which C order is of the reversed shape.
Result<Array> filled(std::string dtype, std::vector<std::int64_t> shape, std::string_view raw,
                     bool is_fortran, std::size_t most_bytes) {
  const std::size_t size = element_size(dtype);
  const auto count = count_of(shape, most_bytes / size);
  if (!count || raw.size() != *count * size) {
    return no_array("an array whose " + std::to_string(raw.size()) +
                    " bytes do not fit its shape and dtype");
  }
  if (!is_fortran || shape.size() < 2)
    return finished({std::move(dtype), std::move(shape), Bytes(raw.begin(), raw.end())});
  Array array{std::move(dtype), shape, Bytes(raw.size())};
  std::vector<std::int64_t> at(shape.size(), 0);
  for (std::size_t i = 0; i < *count; ++i) {
    std::size_t from = 0;
    for (std::size_t axis = shape.size(); axis-- > 0;)
      from = from * static_cast<std::size_t>(shape[axis]) + static_cast<std::size_t>(at[axis]);
    std::memcpy(&array.bytes[i * size], raw.data() + from * size, size);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      if (++at[axis] < shape[axis]) break;
      at[axis] = 0;
    }
  }
  return finished(std::move(array));
}

// Bytes, which pickles before protocol 3 hold as the text of those codes: encode(text, "latin1").
std::optional<std::string> bytes_of(const Pickle& pickle, const Node* node) {
  if (node == nullptr) return std::nullopt;
  if (node->kind == Kind::kBytes) return std::string(node->text);
  if (!is_call_of(pickle, *node, kEncode)) return std::nullopt;
  const Node& given = pickle.at(node->items[1]);
  const Node *text = pickle.item(given, 0), *code = pickle.item(given, 1);
  if (text == nullptr || text->kind != Kind::kText || code == nullptr ||
      code->kind != Kind::kText || code->text != "latin1") {
    return std::nullopt;
  }
  std::string bytes;
  bytes.reserve(text->text.size());
  for (std::string_view rest = text->text; !rest.empty();) {
    const Utf8Char c = first_utf8(rest);
    if (c.bytes == 0 || c.code > 0xff) return std::nullopt;
    bytes += static_cast<char>(c.code);
    rest.remove_prefix(c.bytes);
  }
  return bytes;
}

// _reconstruct(ndarray, (0,), b"b") with the state (1, shape, dtype, is_fortran, bytes).
Result<Array> read_reconstructed(const Pickle& pickle, const Node& node, std::size_t most_bytes) {
  const Node* state = pickle.item(node, 2);
  if (state == nullptr || state->kind != Kind::kTuple) return no_array("an array without a state");
  auto shape = whole_tuple(pickle, pickle.item(*state, 1));
  const Node* is_fortran = pickle.item(*state, 3);
  const auto raw = bytes_of(pickle, pickle.item(*state, 4));
  if (!shape || is_fortran == nullptr || is_fortran->kind != Kind::kBool || !raw) {
    return no_array("an array whose state is not read");
  }
  PROBE_ASSIGN(std::string dtype, read_dtype(pickle, pickle.item(*state, 2)));
  return filled(std::move(dtype), std::move(*shape), *raw, is_fortran->integer != 0, most_bytes);
}

// _frombuffer(bytes, dtype, shape, "C" or "F").
Result<Array> read_from_buffer(const Pickle& pickle, const Node& node, std::size_t most_bytes) {
  const Node& given = pickle.at(node.items[1]);
  const Node *raw = pickle.item(given, 0), *order = pickle.item(given, 3);
  auto shape = whole_tuple(pickle, pickle.item(given, 2));
  if (raw == nullptr || raw->kind != Kind::kBytes || !shape || order == nullptr ||
      order->kind != Kind::kText) {
    return no_array("an array whose buffer is not read");
  }
  PROBE_ASSIGN(std::string dtype, read_dtype(pickle, pickle.item(given, 1)));
  return filled(std::move(dtype), std::move(*shape), raw->text, order->text == "F", most_bytes);
}

// scalar(dtype, bytes).
Result<Array> read_scalar(const Pickle& pickle, const Node& node) {
  const Node& given = pickle.at(node.items[1]);
  const Node* raw = pickle.item(given, 1);
  if (raw == nullptr || raw->kind != Kind::kBytes) return no_array("a number without its bytes");
  PROBE_ASSIGN(std::string dtype, read_dtype(pickle, pickle.item(given, 0)));
  return filled(std::move(dtype), {}, raw->text, false, 8);
}

struct Storage {
  const StorageRow* row = nullptr;
  std::string_view elements;
};

// Five pickles (magic number, version, system, the storage as a reference, keys), then the number
// of elements and these.
Result<Storage> read_storage(std::string_view text) {
  std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()),
                                      text.size());
  const auto next = [&]() -> Result<Pickle> {
    PROBE_ASSIGN(Pickle pickle, read_pickle(bytes, kArrayGlobals, kMostStorageValues));
    bytes = bytes.subspan(pickle.size);
    return pickle;
  };
  PROBE_ASSIGN(const Pickle magic, next());
  const std::string_view wanted(reinterpret_cast<const char*>(kMagicPickle.data()) + kMagicBegin,
                                kMagicSize);
  if (magic.top().kind != Kind::kLong || magic.top().text != wanted)
    return no_array("a storage that is not PyTorch's");
  PROBE_ASSIGN(const Pickle version, next());
  if (whole(&version.top()) != kStorageProtocol)
    return no_array("a storage of " + describe(version, version.top()));
  PROBE_ASSIGN(const Pickle system, next());
  const Node* little = system.find(system.top(), "little_endian");
  if (little == nullptr || little->kind != Kind::kBool || little->integer == 0)
    return no_array("a storage of big-endian numbers");
  // ("storage", torch.FloatStorage, key, "cpu", elements, None)
  PROBE_ASSIGN(const Pickle reference, next());
  const Node* named =
      reference.top().kind == Kind::kOutside ? reference.item(reference.top(), 0) : nullptr;
  if (named == nullptr || named->kind != Kind::kTuple || named->items.size() < 5)
    return no_array("a storage that is no reference");
  const Node &kind = reference.at(named->items[1]), &place = reference.at(named->items[3]);
  if (place.kind != Kind::kText || place.text != "cpu")
    return no_array("a storage at " + describe(reference, place) + ", not on the CPU");
  const auto row = std::ranges::find(kStorages, kind.text, &StorageRow::global);
  if (kind.kind != Kind::kGlobal || row == std::end(kStorages))
    return no_array("a storage that is " + describe(reference, kind));
  const auto count = whole(&reference.at(named->items[4]));
  PROBE_TRY(next());  // the keys, of which there is one
  std::uint64_t stated = 0;
  if (bytes.size() < 8) return no_array("a storage without elements");
  for (std::size_t i = 8; i-- > 0;) stated = stated << 8 | bytes[i];
  bytes = bytes.subspan(8);
  if (!count || *count < 0 || stated != static_cast<std::uint64_t>(*count) ||
      bytes.size() / row->size != stated || bytes.size() % row->size != 0) {
    return no_array("a storage whose bytes do not fit the number of its elements");
  }
  return Storage{row, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

// _rebuild_tensor_v2(storage, offset, size, stride, requires_grad, backward_hooks).
Result<Array> read_tensor(const Pickle& pickle, const Node& node, std::size_t most_bytes) {
  const Node& given = pickle.at(node.items[1]);
  const Node* loaded = pickle.item(given, 0);
  if (loaded == nullptr || !is_call_of(pickle, *loaded, kLoadStorage))
    return no_array("a tensor without a storage");
  const Node* raw = pickle.item(pickle.at(loaded->items[1]), 0);
  const auto offset = whole(pickle.item(given, 1));
  const auto shape = whole_tuple(pickle, pickle.item(given, 2));
  const auto strides = whole_tuple(pickle, pickle.item(given, 3));
  if (raw == nullptr || raw->kind != Kind::kBytes || !offset || *offset < 0 ||
      *offset > kFarthest || !shape || !strides || shape->size() != strides->size()) {
    return no_array("a tensor whose shape is not read");
  }
  PROBE_ASSIGN(const Storage storage, read_storage(raw->text));
  const std::size_t size = storage.row->size;
  const auto count = count_of(*shape, most_bytes / size);
  if (!count) return no_array("a tensor of more than " + std::to_string(most_bytes) + " bytes");
  Array array{std::string(storage.row->dtype), *shape, Bytes(*count * size)};
  if (*count == 0) return finished(std::move(array));
  // The last element that it reaches; nothing here grows beyond the storage, so nothing overflows.
  const auto elements = static_cast<std::int64_t>(storage.elements.size() / size);
  std::int64_t last = *offset;
  for (std::size_t i = 0; i < shape->size() && last < elements; ++i) {
    const std::int64_t steps = (*shape)[i] - 1;
    if (steps == 0) continue;
    last = (*strides)[i] > (elements - last) / steps ? elements : last + steps * (*strides)[i];
  }
  if (last >= elements) return no_array("a tensor that reaches beyond its storage");
  std::vector<std::int64_t> at(shape->size(), 0);
  for (std::size_t i = 0; i < *count; ++i) {
    std::int64_t from = *offset;
    for (std::size_t axis = 0; axis < at.size(); ++axis) from += at[axis] * (*strides)[axis];
    std::memcpy(&array.bytes[i * size],
                storage.elements.data() + static_cast<std::size_t>(from) * size, size);
    for (std::size_t axis = at.size(); axis-- > 0;) {
      if (++at[axis] < (*shape)[axis]) break;
      at[axis] = 0;
    }
  }
  return finished(std::move(array));
}

void write_shape(const std::vector<std::int64_t>& shape, PickleWriter& writer) {
  writer.begin_tuple();
  for (const std::int64_t length : shape) writer.integer(length);
  writer.end_tuple();
}

// A storage as torch.save writes one, see read_storage.
Bytes storage_of(const Array& array, std::size_t size) {
  const auto count = static_cast<std::int64_t>(array.bytes.size() / size);
  Bytes bytes(kMagicPickle.begin(), kMagicPickle.end());
  const auto append = [&](PickleWriter& writer) {
    const Bytes part = writer.finish();
    bytes.insert(bytes.end(), part.begin(), part.end());
  };
  PickleWriter version, system, reference, keys;
  version.integer(kStorageProtocol);
  append(version);
  system.value(Map{{"protocol_version", kStorageProtocol},
                   {"little_endian", true},
                   {"type_sizes", Map{{"short", 2}, {"int", 4}, {"long", 4}}}});
  append(system);
  reference.begin_tuple();
  reference.text("storage");
  reference.global(array.dtype == "<f8" ? kStorages[1].global : kStorages[0].global);
  reference.text("0");
  reference.text("cpu");
  reference.integer(count);
  reference.none();
  reference.end_tuple();
  reference.outside();
  append(reference);
  keys.value(List{"0"});
  append(keys);
  for (int shift = 0; shift < 64; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(count) >> shift & 0xff));
  bytes.insert(bytes.end(), array.bytes.begin(), array.bytes.end());
  return bytes;
}

}  // namespace

std::span<const std::string_view> array_globals() { return kArrayGlobals; }

Result<Array> read_array(const Pickle& pickle, const PickleNode& node, std::size_t most_bytes) {
  for (const std::string_view global : {kReconstruct, kNewReconstruct}) {
    if (is_call_of(pickle, node, global)) return read_reconstructed(pickle, node, most_bytes);
  }
  for (const std::string_view global : {kFromBuffer, kNewFromBuffer}) {
    if (is_call_of(pickle, node, global)) return read_from_buffer(pickle, node, most_bytes);
  }
  for (const std::string_view global : {kScalar, kNewScalar}) {
    if (is_call_of(pickle, node, global)) return read_scalar(pickle, node);
  }
  if (is_call_of(pickle, node, kRebuildTensor)) return read_tensor(pickle, node, most_bytes);
  return no_array("expected an array, got " + describe(pickle, node));
}

void write_numpy(const Array& array, PickleWriter& writer) {
  writer.global(kReconstruct);
  writer.begin_tuple();
  writer.global(kNdarray);
  write_shape({0}, writer);
  writer.bytes(std::array<std::uint8_t, 1>{'b'});
  writer.end_tuple();
  writer.call();
  writer.begin_tuple();
  writer.integer(1);
  write_shape(array.shape, writer);
  writer.global(kDtype);
  writer.begin_tuple();
  writer.text(std::string_view(array.dtype).substr(1));
  writer.boolean(false);
  writer.boolean(true);
  writer.end_tuple();
  writer.call();
  writer.begin_tuple();
  writer.integer(3);
  writer.text(std::string_view(array.dtype).substr(0, 1));
  for (int i = 0; i < 3; ++i) writer.none();
  writer.integer(-1);
  writer.integer(-1);
  writer.integer(0);
  writer.end_tuple();
  writer.set_state();
  writer.boolean(false);
  writer.bytes(array.bytes);
  writer.end_tuple();
  writer.set_state();
}

void write_torch(const Array& array, PickleWriter& writer) {
  writer.global(kRebuildTensor);
  writer.begin_tuple();
  writer.global(kLoadStorage);
  writer.begin_tuple();
  writer.bytes(storage_of(array, element_size(array.dtype)));
  writer.end_tuple();
  writer.call();
  writer.integer(0);
  write_shape(array.shape, writer);
  std::vector<std::int64_t> strides(array.shape.size(), 1);
  for (std::size_t i = strides.size(); i-- > 1;) strides[i - 1] = strides[i] * array.shape[i];
  write_shape(strides, writer);
  writer.boolean(false);
  writer.global(kOrderedDict);
  writer.begin_tuple();
  writer.end_tuple();
  writer.call();
  writer.end_tuple();
  writer.call();
}

}  // namespace probe::wire
