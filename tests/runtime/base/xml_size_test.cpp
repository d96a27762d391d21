#include "runtime/base/xml_size.h"

#include <doctest/doctest.h>

namespace probe {

TEST_CASE("elements, levels and attributes of XML are counted where TinyXML sees them") {
  struct Case {
    const char* text;
    std::size_t elements, depth, attributes;
  };
  constexpr Case kCases[] = {
      {"", 0, 0, 0},
      {"<", 0, 0, 0},
      {"<a/>", 1, 1, 0},
      {"<a><b x='1' y=\"2\"/><c>text = '</c></a>", 3, 2, 2},
      {"<?xml version=\"1.0\" encoding='utf-8'?>\n<a><b/></a>", 2, 2, 0},
      {"<?xml version='1.0' ?><a/>", 1, 1, 0},
      {"<!DOCTYPE a><a/>", 1, 1, 0},
      // Nothing within a comment, a value or CDATA is an element, or ends one.
      {"<!-- <a ' --><a x=''/>", 1, 1, 1},
      {"<!-- <a><b><c> --><a/>", 1, 1, 0},
      {"<a x='/>'><b x='</a>'><c x=\"<d><e>\"/></b></a>", 3, 3, 1},
      {"<![CDATA[<a ']]><a x=''/>", 1, 1, 1},
      {"<a><_><\xc3\xa9/></_></a>", 3, 3, 0},
      {"<a b=c/><d/>", 2, 1, 1},
      {"<a x='1' y='2", 1, 1, 2},
  };
  for (const Case& one : kCases) {
    CAPTURE(one.text);
    const XmlSize size = xml_size(one.text);
    CHECK(size.elements == one.elements);
    CHECK(size.depth == one.depth);
    CHECK(size.attributes == one.attributes);
    CHECK(!size.is_odd);
  }
  // What could end elsewhere than it seems to hides nothing: it is odd.
  for (const char* text : {"<?xml version=\"><!--\"?><a>", "<?xml a\"b version=\"?><!--\"?><a>",
                           "<?xml version=1.0?><a/>", "<?xml", "<?"}) {
    CAPTURE(text);
    CHECK(xml_size(text).is_odd);
  }
}

}  // namespace probe
