// The page of a run as a PDF, printed by a headless Chromium where there is one.
#pragma once

#include <string>

namespace swarf::cli {

/// Before any work. Throws InputError "no-chromium".
void require_chromium();

/// Prints a page to `pdf`, with page numbers, replaced whole. Throws InputError "pdf-write" when the browser
/// leaves none.
void write_page_pdf(const std::string& page, const std::string& pdf);

}  // namespace swarf::cli
