// The steps of the flow: jumps, loops, calls, declarations.
#pragma once

#include <string>
#include <vector>

#include "program/siemens/flow.h"

namespace swarf::program::nc::siemens {

// --- flow.cpp
void finish_block(TokenReader& reader, std::string_view after);
/// What a word of the flow does; null for other words.
using Handler = void (*)(Flow&, TokenReader&);
Handler handler_of(const std::string& word);

// --- calls.cpp
void on_repeat(Flow& flow, TokenReader& reader);
void on_proc(Flow& flow, TokenReader& reader);
void on_extern(Flow& flow, TokenReader& reader);
void on_call(Flow& flow, TokenReader& reader);
void on_mcall(Flow& flow, TokenReader& reader);
bool subprogram_here(Flow& flow, TokenReader& reader);
/// The blocks of target.contour_asked() come next.
void enter_contour(Flow& flow);
void call(Flow& flow, int file, TokenReader* arguments, const std::vector<Value>& values, int times);

// --- declare.cpp
void on_def(Flow& flow, TokenReader& reader);

}  // namespace swarf::program::nc::siemens
