// Which axes matter and which two matter together, as a matrix: an axis by itself on the diagonal,
// pairs below it.
#pragma once

#include <string>

#include "runtime/report/search_findings.h"

namespace probe::report {

// As HTML, of a search of `axes`: the matrix, the pairs that are named in words, a table of axes.
std::string interaction_map(const SearchFindings& found);

// "at least 85 %": what of the variance of the outcome an axis is sure to explain together with its
// pairs. The estimate and its upper end hold for the axis in parts alone, the lower end for the
// axis itself, too (method/README.md). Empty: nothing is sure.
std::string total_text(const AxisShare& axis);

}  // namespace probe::report
