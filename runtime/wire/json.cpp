#include "runtime/wire/json.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/wire/base64.h"

namespace probe::wire {
namespace {

using Json = nlohmann::json;

constexpr int kMostLevels = 64;

Failure bad_json(const std::string& message) { return {Fault::kPolicy, message, ""}; }

// ---- writing ----------------------------------------------------------------------------------

std::string quoted(const std::string& text) {
  // What is no UTF-8 is replaced: a message must always be readable.
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_number(std::string& out, double value) {
  if (std::isnan(value)) {
    out += "NaN";
    return;
  }
  if (std::isinf(value)) {
    out += value > 0 ? "Infinity" : "-Infinity";
    return;
  }
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  const std::string_view text(digits, static_cast<std::size_t>(end - digits));
  out += text;
  // A reader that tells floats from integers must see a float.
  if (text.find_first_of(".e") == std::string_view::npos) out += ".0";
}

// By hand, because a picture's megabyte of base64 needs no look for escapes.
void append(std::string& out, const Value& value) {
  if (const auto* b = value.as<bool>()) {
    out += *b ? "true" : "false";
  } else if (const auto* i = value.as<std::int64_t>()) {
    out += std::to_string(*i);
  } else if (const auto* d = value.as<double>()) {
    append_number(out, *d);
  } else if (const auto* s = value.as<std::string>()) {
    out += quoted(*s);
  } else if (const auto* bytes = value.as<Bytes>()) {
    out.append("\"").append(to_base64(*bytes)).append("\"");
  } else if (const auto* array = value.as<Array>()) {
    out.append("{\"__numpy__\": \"").append(to_base64(array->bytes)).append("\", \"dtype\": ");
    out.append(quoted(array->dtype)).append(", \"shape\": [");
    for (std::size_t k = 0; k < array->shape.size(); ++k) {
      out.append(k > 0 ? ", " : "").append(std::to_string(array->shape[k]));
    }
    out += "]}";
  } else if (const auto* list = value.as<List>()) {
    out += '[';
    for (std::size_t k = 0; k < list->size(); ++k) {
      if (k > 0) out += ", ";
      append(out, (*list)[k]);
    }
    out += ']';
  } else if (const auto* map = value.as<Map>()) {
    out += '{';
    for (std::size_t k = 0; k < map->size(); ++k) {
      if (k > 0) out += ", ";
      out.append(quoted((*map)[k].first)).append(": ");
      append(out, (*map)[k].second);
    }
    out += '}';
  } else {
    out += "null";
  }
}

// ---- reading ----------------------------------------------------------------------------------

// Before parsing, which would build every level and every value.
Status check_extent(std::string_view text) {
  int depth = 0;
  std::size_t values = 1;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    const bool opens = c == '[' || c == '{';
    if (opens && ++depth > kMostLevels)
      return bad_json("JSON of more than " + std::to_string(kMostLevels) + " levels");
    if (c == ']' || c == '}') --depth;
    if ((opens || c == ',') && ++values > kMostValues)
      return bad_json("JSON of more than " + std::to_string(kMostValues) + " values");
  }
  return {};
}

Result<Value> read_marked(const Json& map) {
  const auto dtype = map.find("dtype");
  const auto shape = map.find("shape");
  const Json& data = map.at("__numpy__");
  if (!data.is_string() || dtype == map.end() || !dtype->is_string() || shape == map.end() ||
      !shape->is_array()) {
    return bad_json("an array needs `__numpy__` and `dtype` as texts and a list `shape`");
  }
  Array array{dtype->get<std::string>(), {}, {}};
  if (shape->size() > kMostDimensions) return bad_json("an array's `shape` has too many sizes");
  for (const Json& n : *shape) {
    if (!n.is_number_unsigned() || n.get<std::uint64_t>() > (std::uint64_t{1} << 40)) {
      return bad_json("an array's `shape` is not made of sizes");
    }
    array.shape.push_back(n.get<std::int64_t>());
  }
  auto bytes = from_base64(data.get_ref<const std::string&>());
  if (!bytes) return bad_json("an array's `__numpy__` is no base64");
  array.bytes = std::move(*bytes);
  PROBE_TRY(check_fit(array));
  return Value(std::move(array));
}

Result<Value> read(const Json& json) {
  switch (json.type()) {
    case Json::value_t::boolean:
      return Value(json.get<bool>());
    case Json::value_t::number_integer:
      return Value(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      // Beyond 2^63 an integer is nothing of ours; its size is kept, its last digits are not.
      if (json.get<std::uint64_t>() >> 63 != 0) return Value(json.get<double>());
      return Value(json.get<std::int64_t>());
    case Json::value_t::number_float:
      return Value(json.get<double>());
    case Json::value_t::string:
      return Value(json.get<std::string>());
    case Json::value_t::array: {
      List list;
      for (const Json& element : json) {
        PROBE_ASSIGN(Value value, read(element));
        list.push_back(std::move(value));
      }
      return Value(std::move(list));
    }
    case Json::value_t::object: {
      if (json.contains("__numpy__")) return read_marked(json);
      Map map;
      for (const auto& [key, element] : json.items()) {
        PROBE_ASSIGN(Value value, read(element));
        map.emplace_back(key, std::move(value));
      }
      return Value(std::move(map));
    }
    default:
      return Value();
  }
}

}  // namespace

std::string to_json(const Value& value) {
  std::string out;
  append(out, value);
  return out;
}

Result<Value> from_json(std::string_view text) {
  if (text.empty()) return bad_json("no JSON but an empty text");
  PROBE_TRY(check_extent(text));
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) {
    return bad_json("no JSON but " + describe(std::string(text.substr(0, 200))));
  }
  return read(json);
}

}  // namespace probe::wire
