// How much XML text asks of TinyXML before it is parsed: that recurses once a level of elements and
// takes the square of an element's attributes. One pass, which sees elements, comments and values
// where TinyXML sees them; whether the text is XML otherwise is TinyXML's to say.
#pragma once

#include <cstddef>
#include <string_view>

namespace probe {

struct XmlSize {
  std::size_t elements = 0;
  std::size_t depth = 0;       // levels of elements
  std::size_t attributes = 0;  // of the element that has most
  // A `<?...?>` that is no list of `name="value"`, which could end elsewhere than it seems to:
  // only what is before it is counted.
  bool is_odd = false;
};

XmlSize xml_size(std::string_view text);

// More than any element of a robot, a model or a scene has.
inline constexpr std::size_t kMostXmlAttributes = 100;

}  // namespace probe
