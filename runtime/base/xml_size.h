// How much XML text asks of TinyXML before it is parsed: that recurses once a level of elements and
// takes the square of an element's attributes. One pass, which sees elements, comments and values
// where TinyXML sees them; whether the text is XML otherwise is TinyXML's to say.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "runtime/base/result.h"

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

// Fails with `code` where text asks more than any robot, model or scene does. `elements`: of the
// texts that belong to it and were asked before; this one's are added.
Status check_xml_size(std::string_view text, Fault code, const std::string& path,
                      std::size_t* elements);

}  // namespace probe
