#include "runtime/base/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <ostream>

#include "runtime/base/check.h"

namespace probe {
namespace {

using Theirs = nlohmann::ordered_json;

// Trees are freed and written by recursion: what is nested deeper is refused as no JSON of ours.
constexpr std::size_t kMaxDepth = 500;
// Of a text that is parsed: a value takes a hundred times the two bytes it may have there.
constexpr std::size_t kMostValues = 4'000'000;

// Of keys that are repeated the last value counts, at the place of the first.
void drop_repeats(Json::Object& object) {
  std::vector<std::size_t> order(object.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return object[a].first < object[b].first;
  });
  std::vector<bool> drop(object.size());
  bool any = false;
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (i == 0 || object[order[i]].first != object[order[first]].first) {
      first = i;
      continue;
    }
    object[order[first]].second = std::move(object[order[i]].second);
    drop[order[i]] = any = true;
  }
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < object.size(); ++i) {
    if (drop[i]) continue;
    if (kept != i) object[kept] = std::move(object[i]);
    ++kept;
  }
  object.resize(kept);
}

// Builds the tree from what nlohmann's parser reports. Every function says whether to go on.
class Builder {
 public:
  explicit Builder(Json& root) : root_(root) {}

  bool null() { return add(Json()); }
  bool boolean(bool value) { return add(Json(value)); }
  bool number_integer(std::int64_t value) { return add(Json(value)); }
  bool number_unsigned(std::uint64_t value) { return add(Json(value)); }
  bool number_float(double value, const std::string&) { return add(Json(value)); }
  bool string(std::string& value) { return add(Json(std::move(value))); }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(Json::object()); }
  bool start_array(std::size_t) { return open(Json::array()); }
  bool key(std::string& name) {
    open_.back()->items().emplace_back(std::move(name), Json());
    return true;
  }
  bool end_object() {
    drop_repeats(open_.back()->items());
    return end_array();
  }
  bool end_array() {
    open_.pop_back();
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) {
    return false;
  }

 private:
  Json& place(Json value) {
    if (open_.empty()) return root_ = std::move(value);
    Json& inside = *open_.back();
    if (inside.is_object()) return inside.items().back().second = std::move(value);
    inside.push_back(std::move(value));
    return inside.back();
  }
  bool add(Json value) {
    if (++values_ > kMostValues) return false;
    place(std::move(value));
    return true;
  }
  // A container's address holds while it is open: what is around it does not grow meanwhile.
  bool open(Json value) {
    if (open_.size() == kMaxDepth || ++values_ > kMostValues) return false;
    open_.push_back(&place(std::move(value)));
    return true;
  }

  Json& root_;
  std::vector<Json*> open_;
  std::size_t values_ = 0;
};

}  // namespace

Json::Json() noexcept = default;
Json::Json(std::nullptr_t) noexcept {}
Json::Json(const char* text) : value_(std::string(text)) {}
Json::Json(std::string text) : value_(std::move(text)) {}
Json::Json(std::string_view text) : value_(std::string(text)) {}
Json::Json(Array elements) : value_(std::move(elements)) {}
Json::Json(Number, bool value) : value_(value) {}
Json::Json(Number, std::int64_t value) : value_(value) {}
Json::Json(Number, std::uint64_t value) : value_(value) {}
Json::Json(Number, double value) : value_(value) {}

Json::Json(std::initializer_list<JsonItem> items) {
  const bool pairs = items.size() > 0 && std::all_of(items.begin(), items.end(), [](auto& item) {
    const Json& json = item.peek();
    return json.is_array() && json.size() == 2 && json[0].is_string();
  });
  if (!pairs) {
    *this = array(items);
    return;
  }
  Object& object = value_.emplace<Object>();
  object.reserve(items.size());
  for (const JsonItem& item : items) {
    Json pair = item.take();
    object.emplace_back(std::move(std::get<std::string>(pair[0].value_)), std::move(pair[1]));
  }
  drop_repeats(object);
}

Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

Json Json::array(std::initializer_list<JsonItem> items) {
  Array elements;
  elements.reserve(items.size());
  for (const JsonItem& item : items) elements.push_back(item.take());
  return Json(std::move(elements));
}

Json Json::object() {
  Json json;
  json.value_.emplace<Object>();
  return json;
}

Json Json::parse(std::string_view text) {
  Json root;
  Builder builder(root);
  if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder)) {
    root.value_.emplace<Discarded>();
  }
  return root;
}

namespace {

Theirs to_theirs(const Json& json) {
  if (json.is_object()) {
    Theirs::object_t object;
    // Keys are known to differ; emplace of their ordered object would look for each.
    std::vector<std::pair<const std::string, Theirs>>& pairs = object;
    pairs.reserve(json.size());
    for (const auto& [key, value] : json.items()) pairs.emplace_back(key, to_theirs(value));
    return Theirs(std::move(object));
  }
  if (json.is_array()) {
    Theirs::array_t array;
    array.reserve(json.size());
    for (const Json& element : json) array.push_back(to_theirs(element));
    return Theirs(std::move(array));
  }
  if (json.is_string()) return Theirs(json.text());
  if (json.is_boolean()) return Theirs(json.get<bool>());
  if (json.is_number_unsigned()) return Theirs(json.get<std::uint64_t>());
  if (json.is_number_integer()) return Theirs(json.get<std::int64_t>());
  if (json.is_number()) return Theirs(json.get<double>());
  return {};
}

}  // namespace

std::string Json::dump(int indent) const {
  return to_theirs(*this).dump(indent, ' ', false, Theirs::error_handler_t::replace);
}

Json Json::sorted() const {
  if (is_array()) {
    Array out;
    for (const Json& element : *this) out.push_back(element.sorted());
    return Json(std::move(out));
  }
  if (!is_object()) return *this;
  Json out = object();
  for (const auto& [key, value] : items()) out.items().emplace_back(key, value.sorted());
  std::sort(out.items().begin(), out.items().end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

bool Json::is_number_unsigned() const {
  if (const auto* value = std::get_if<std::int64_t>(&value_)) return *value >= 0;
  return std::holds_alternative<std::uint64_t>(value_);
}

std::size_t Json::size() const {
  if (is_null()) return 0;
  if (is_object()) return std::get<Object>(value_).size();
  return is_array() ? std::get<Array>(value_).size() : 1;
}

bool Json::boolean() const {
  PROBE_CHECK(is_boolean(), "this JSON value is true or false");
  return std::get<bool>(value_);
}

double Json::real() const {
  if (const auto* value = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*value);
  if (const auto* value = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*value);
  PROBE_CHECK(std::holds_alternative<double>(value_), "this JSON value is a number");
  return std::get<double>(value_);
}

// Of a number beyond 2^63 the bits, which the cast to an unsigned type undoes.
std::int64_t Json::whole() const {
  if (const auto* value = std::get_if<std::int64_t>(&value_)) return *value;
  if (const auto* value = std::get_if<std::uint64_t>(&value_)) {
    return static_cast<std::int64_t>(*value);
  }
  return static_cast<std::int64_t>(real());
}

const std::string& Json::text() const {
  PROBE_CHECK(is_string(), "this JSON value is a text");
  return std::get<std::string>(value_);
}

const Json::Array& Json::elements() const {
  static const Array kNone;
  const auto* array = std::get_if<Array>(&value_);
  return array != nullptr ? *array : kNone;
}

const Json& Json::element(std::size_t index) const {
  PROBE_CHECK(index < elements().size(), "this JSON array has that many elements");
  return elements()[index];
}

Json* Json::begin() { return const_cast<Json*>(std::as_const(*this).begin()); }
Json* Json::end() { return const_cast<Json*>(std::as_const(*this).end()); }

void Json::push_back(Json element) {
  if (is_null()) value_.emplace<Array>();
  PROBE_CHECK(is_array(), "only a JSON array takes elements");
  std::get<Array>(value_).push_back(std::move(element));
}

const Json::Object& Json::items() const {
  static const Object kNone;
  const auto* object = std::get_if<Object>(&value_);
  return object != nullptr ? *object : kNone;
}

Json::Object& Json::items() {
  PROBE_CHECK(is_object(), "this JSON value is an object");
  return std::get<Object>(value_);
}

const Json* Json::find(std::string_view key) const {
  for (const auto& [name, value] : items()) {
    if (name == key) return &value;
  }
  return nullptr;
}

Json* Json::find(std::string_view key) {
  return const_cast<Json*>(std::as_const(*this).find(key));
}

Json Json::value(std::string_view key, Json fallback) const {
  const Json* found = find(key);
  return found != nullptr ? *found : fallback;
}

std::string Json::value(std::string_view key, const char* fallback) const {
  const Json* found = find(key);
  return found != nullptr && found->is_string() ? found->text() : fallback;
}

void Json::update(const Json& other) {
  for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

void Json::erase(std::string_view key) {
  std::erase_if(items(), [&](const auto& pair) { return pair.first == key; });
}

const Json& Json::operator[](std::string_view key) const {
  const Json* found = find(key);
  PROBE_CHECK(found != nullptr, "this JSON object has that key");
  return *found;
}

Json& Json::operator[](std::string_view key) {
  if (is_null()) value_.emplace<Object>();
  if (Json* found = find(key)) return *found;
  return items().emplace_back(std::string(key), Json()).second;
}

bool operator==(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) {
    if (a.is_number_unsigned() && b.is_number_unsigned()) {
      return a.get<std::uint64_t>() == b.get<std::uint64_t>();
    }
    if (a.is_number_integer() && b.is_number_integer()) {
      return a.is_number_unsigned() == b.is_number_unsigned() && a.whole() == b.whole();
    }
    return a.real() == b.real();
  }
  if (a.value_.index() != b.value_.index()) return false;
  if (a.is_boolean()) return a.boolean() == b.boolean();
  if (a.is_string()) return a.text() == b.text();
  if (a.is_array()) return a.elements() == b.elements();
  if (!a.is_object()) return !a.is_discarded();
  if (a.size() != b.size()) return false;
  return std::all_of(a.items().begin(), a.items().end(), [&](const auto& pair) {
    const Json* other = b.find(pair.first);
    return other != nullptr && pair.second == *other;
  });
}

std::ostream& operator<<(std::ostream& out, const Json& json) { return out << json.dump(); }

}  // namespace probe
