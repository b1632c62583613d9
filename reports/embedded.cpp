#include "reports/embedded.h"

// The assembler copies the files in: no generated source, and nothing to parse. The paths come from
// CMakeLists.txt, which also rebuilds this file when one of them changes.
#define SWARF_EMBED(symbol, path)                                                \
  asm(".pushsection .rodata\n" #symbol "_begin:\n.incbin \"" path "\"\n" #symbol \
      "_end:\n"                                                                  \
      ".popsection\n");                                                          \
  extern "C" const char symbol##_begin[];                                        \
  extern "C" const char symbol##_end[]

SWARF_EMBED(swarf_style_sheet, SWARF_STYLE_SHEET);
SWARF_EMBED(swarf_page_script, SWARF_PAGE_SCRIPT);
SWARF_EMBED(swarf_viewer_script, SWARF_VIEWER_SCRIPT);
SWARF_EMBED(swarf_viewer_licence, SWARF_VIEWER_LICENCE);

namespace swarf::reports {

std::string_view style_sheet() {
  return {swarf_style_sheet_begin, swarf_style_sheet_end};
}
std::string_view page_script() {
  return {swarf_page_script_begin, swarf_page_script_end};
}
std::string_view viewer_script() {
  return {swarf_viewer_script_begin, swarf_viewer_script_end};
}
std::string_view viewer_licence() {
  return {swarf_viewer_licence_begin, swarf_viewer_licence_end};
}

}  // namespace swarf::reports
