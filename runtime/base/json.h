// JSON values as a tree: what the verbs print and what small files hold. An object keeps the order
// in which its keys were added. Reading and writing text is nlohmann's work, behind json.cpp alone:
// its headers cost seconds in every file that includes them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace probe {

class JsonItem;

class Json {
 public:
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;

  Json() noexcept;
  Json(std::nullptr_t) noexcept;
  Json(const char* text);
  Json(std::string text);
  Json(std::string_view text);
  Json(Array elements);
  // An object if every item is a pair that begins with a text, an array otherwise: {{"a", 1}} is
  // an object, {1, 2} and {} are arrays.
  Json(std::initializer_list<JsonItem> items);
  template <class T>
    requires std::is_arithmetic_v<T>
  Json(T number) : Json(Number{}, widen(number)) {}
  template <class T>
  Json(const std::vector<T>& elements) : Json(array()) {
    for (const auto& element : elements) push_back(Json(element));
  }

  template <class T, std::size_t N>
  Json(const std::array<T, N>& elements) : Json(array()) {
    for (const T& element : elements) push_back(Json(element));
  }

  // A pair is an array of two.
  template <class A, class B>
  Json(const std::pair<A, B>& pair) : Json(array()) {
    push_back(Json(pair.first));
    push_back(Json(pair.second));
  }

  Json(const Json& other);
  Json(Json&& other) noexcept;
  Json& operator=(const Json& other);
  Json& operator=(Json&& other) noexcept;
  ~Json();

  static Json array() { return Json(Array()); }
  static Json array(std::initializer_list<JsonItem> items);
  static Json object();

  // No JSON, more than 500 levels or 4 million values give one that is_discarded(), nothing else.
  static Json parse(std::string_view text);

  // `indent` spaces a level, or one line when it is negative. Bytes that are not UTF-8 are written
  // as U+FFFD; numbers as the shortest text that reads back the same.
  std::string dump(int indent = -1) const;
  // The same tree with the keys of every object in the order of their bytes.
  Json sorted() const;

  bool is_null() const { return value_.index() == 0; }
  bool is_boolean() const { return value_.index() == 1; }
  bool is_number_integer() const { return value_.index() == 2 || value_.index() == 3; }
  bool is_number_unsigned() const;  // whole and not negative
  bool is_number() const { return value_.index() >= 2 && value_.index() <= 4; }
  bool is_string() const { return value_.index() == 5; }
  bool is_array() const { return value_.index() == 6; }
  bool is_object() const { return value_.index() == 7; }
  bool is_discarded() const { return value_.index() == 8; }

  // Of an array or object the number of elements; 0 of null, 1 of anything else.
  std::size_t size() const;
  bool empty() const { return size() == 0; }

  // The kind has to be right, a number may be of any kind: PROBE_CHECK.
  template <class T>
  T get() const {
    if constexpr (std::is_same_v<T, bool>) {
      return boolean();
    } else if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(real());
    } else if constexpr (std::is_integral_v<T>) {
      return static_cast<T>(whole());
    } else if constexpr (std::is_same_v<T, std::string>) {
      return text();
    } else {
      T out;
      for (const Json& element : elements()) out.push_back(element.get<typename T::value_type>());
      return out;
    }
  }
  const std::string& text() const;

  // Elements of an array; of anything else none.
  const Json* begin() const { return elements().data(); }
  const Json* end() const { return elements().data() + elements().size(); }
  Json* begin();
  Json* end();
  const Json& front() const { return (*this)[0]; }
  const Json& back() const { return (*this)[size() - 1]; }
  Json& back() { return (*this)[size() - 1]; }
  // null becomes an array.
  void push_back(Json element);

  // Pairs of an object, in order; of anything else none.
  const Object& items() const;
  Object& items();
  const Json* find(std::string_view key) const;  // null if there is none, or this is no object
  Json* find(std::string_view key);
  bool contains(std::string_view key) const { return find(key) != nullptr; }
  const Json& at(std::string_view key) const { return (*this)[key]; }
  // `fallback` where the key is missing, or is no text.
  Json value(std::string_view key, Json fallback) const;
  std::string value(std::string_view key, const char* fallback) const;
  // Sets every key of `other`, an object.
  void update(const Json& other);
  void erase(std::string_view key);

  // An element that has to be there; the key of an object that is written is made, with null, and
  // null becomes an object.
  const Json& operator[](std::string_view key) const;
  Json& operator[](std::string_view key);
  template <class T>
    requires std::is_integral_v<T>
  const Json& operator[](T index) const {
    return element(static_cast<std::size_t>(index));
  }
  template <class T>
    requires std::is_integral_v<T>
  Json& operator[](T index) {
    return const_cast<Json&>(element(static_cast<std::size_t>(index)));
  }

  // Numbers by value, objects whatever the order of their keys.
  friend bool operator==(const Json& a, const Json& b);
  friend std::ostream& operator<<(std::ostream& out, const Json& json);

 private:
  struct Discarded {};
  struct Number {};
  using Value = std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string,
                             Array, Object, Discarded>;

  Json(Number, bool value);
  Json(Number, std::int64_t value);
  Json(Number, std::uint64_t value);
  Json(Number, double value);
  template <class T>
  static auto widen(T number) {
    if constexpr (std::is_same_v<T, bool>) {
      return number;
    } else if constexpr (std::is_floating_point_v<T>) {
      return static_cast<double>(number);
    } else if constexpr (std::is_signed_v<T>) {
      return static_cast<std::int64_t>(number);
    } else {
      return static_cast<std::uint64_t>(number);
    }
  }
  bool boolean() const;
  double real() const;
  std::int64_t whole() const;
  const Array& elements() const;
  const Json& element(std::size_t index) const;

  Value value_;
};

// An element of a braced list. Lists hand out their elements as const; this one may be moved from.
class JsonItem {
 public:
  JsonItem(std::initializer_list<JsonItem> items) : json_(items) {}
  template <class T>
    requires std::is_constructible_v<Json, T&&>
  JsonItem(T&& value) : json_(std::forward<T>(value)) {}

  const Json& peek() const { return json_; }
  Json take() const { return std::move(json_); }

 private:
  mutable Json json_;
};

}  // namespace probe
