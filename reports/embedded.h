// The files of reports/template and assets/viewer that every report carries, linked into the program, so that
// it finds them wherever it is installed.
#pragma once

#include <string_view>

namespace swarf::reports {

std::string_view style_sheet();     ///< template/report.css
std::string_view page_script();     ///< template/report.js: readings under the pointer in plots
std::string_view viewer_script();   ///< assets/viewer/viewer.min.js
std::string_view viewer_licence();  ///< of three.js in it: goes wherever the script goes

}  // namespace swarf::reports
