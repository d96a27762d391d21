// Attributes of an element over those of its classes, as numbers and words.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/geometry.h"
#include "runtime/base/result.h"
#include "runtime/mjcf/model.h"
#include "runtime/mjcf/xml.h"

namespace probe::mjcf {

// What an element says itself, else the nearest of its classes that says it. Lists are separated by
// blanks. Every read fails (kAsset, where = the place of the text) as read_model says; a value that
// is not there leaves what was.
class Values {
 public:
  // `classes` from the nearest on.
  Values(const Document& document, const Element& element,
         std::vector<const Element*> classes = {});

  struct Value {
    std::string_view text;
    At at;
  };
  std::optional<Value> find(std::string_view name) const;
  std::optional<Value> own(std::string_view name) const;  // of the element alone
  bool has(std::string_view name) const { return find(name).has_value(); }

  Status read(std::string_view name, double& to) const;
  Status read_not_negative(std::string_view name, double& to) const;
  Status read(std::string_view name, int& to) const;
  Status read(std::string_view name, bool& to) const;  // true, false
  Status read(std::string_view name, std::string& to) const;
  Status read(std::string_view name, Vec3& to) const;
  // As many numbers as there are, at least `least`, the others stay; `count` is how many.
  Status read(std::string_view name, std::span<double> to, std::size_t least,
              std::size_t* count = nullptr) const;
  // One of `words`; `to` is its index.
  Status read_word(std::string_view name, std::span<const std::string_view> words,
                   std::size_t& to) const;

  Failure fail(const At& at, std::string message) const;
  Failure fail(std::string message) const { return fail(element_->at, std::move(message)); }
  const At& at() const { return element_->at; }

 private:
  const Document* document_;
  const Element* element_;
  std::vector<const Element*> classes_;
};

// quat, axisangle, euler, xyaxes or zaxis; what the element says itself comes before what its
// classes say.
Status read_rotation(const Values& values, const Compiler& compiler, Quat& to);
// The shortest turn that takes z to `axis`, which is unit.
Quat turn_of_z(const Vec3& axis);

// Classes of `default` elements by name; "main" is the outermost.
class Classes {
 public:
  // Fails (kAsset) on a class of a name that is taken or without one.
  static Result<Classes> read(const Document& document);

  bool has(std::string_view name) const { return classes_.find(name) != classes_.end(); }
  // What is said of elements of this tag, the nearest first.
  std::vector<const Element*> of(std::string_view name, std::string_view tag) const;

 private:
  struct Class {
    std::string parent;  // empty: none
    std::vector<const Element*> elements;
  };
  Status add(const Document& document, const Element& element, const std::string& parent);
  std::map<std::string, Class, std::less<>> classes_;
};

}  // namespace probe::mjcf
