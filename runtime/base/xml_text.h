// Text between and within the tags of XML: SVG, JUnit.
#pragma once

#include <string>
#include <string_view>

namespace probe {

// With `&`, `<`, `>` and double quotes escaped, and without control
// characters but line breaks and tabs, which XML 1.0 cannot hold.
std::string xml_text(std::string_view text);

}  // namespace probe
