#include "runtime/base/invisible.h"

#include <utf8proc.h>

namespace probe {

bool is_invisible(char32_t code) {
  if (code < 0x80 || is_joiner(code)) return false;
  // Without a character as yet, but set aside to be ignored; and marks between lines of notes.
  if (code == 0x2065 || (code >= 0xfff0 && code <= 0xfffb) || (code >= 0xe0000 && code <= 0xe0fff))
    return true;
  const utf8proc_property_t& property = *utf8proc_get_property(static_cast<utf8proc_int32_t>(code));
  return property.ignorable || property.category == UTF8PROC_CATEGORY_ZL ||
         property.category == UTF8PROC_CATEGORY_ZP;
}

}  // namespace probe
