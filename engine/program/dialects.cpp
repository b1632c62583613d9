#include "program/dialects.h"

#include <algorithm>
#include <array>

#include "program/fanuc/dialect.h"
#include "program/haas/dialect.h"
#include "program/heidenhain/dialect.h"
#include "program/linuxcnc/dialect.h"
#include "program/mazak/dialect.h"
#include "program/siemens/dialect.h"

namespace swarf::program {
namespace {

using namespace std::string_view_literals;

constexpr std::array kLinuxCncEndings{".ngc"sv};
constexpr std::array kFanucEndings{".tap"sv, ".eia"sv};
constexpr std::array kSiemensEndings{".mpf"sv, ".spf"sv};
constexpr std::array kHeidenhainEndings{".h"sv};

constexpr std::array kDialects{
    DialectRow{Dialect::kLinuxCnc, "linuxcnc", kLinuxCncEndings, nc::linuxcnc::evidence, nc::linuxcnc::run},
    DialectRow{Dialect::kFanuc, "fanuc", kFanucEndings, nc::fanuc::evidence, nc::fanuc::run},
    DialectRow{Dialect::kSiemens, "siemens", kSiemensEndings, nc::siemens::evidence, nc::siemens::run},
    DialectRow{Dialect::kHeidenhain, "heidenhain", kHeidenhainEndings, nc::heidenhain::evidence,
               nc::heidenhain::run},
    DialectRow{Dialect::kHaas, "haas", {}, nc::haas::evidence, nc::haas::run},
    DialectRow{Dialect::kMazak, "mazak", {}, nc::mazak::evidence, nc::mazak::run},
};

constexpr bool rows_follow_the_enum() {
  for (size_t i = 0; i < kDialects.size(); ++i) {
    if (kDialects[i].dialect != static_cast<Dialect>(i)) return false;
  }
  return true;
}
static_assert(rows_follow_the_enum(), "dialect_row() finds a row by its place");

}  // namespace

std::span<const DialectRow> dialects() {
  return kDialects;
}

const DialectRow& dialect_row(Dialect dialect) {
  return kDialects[static_cast<size_t>(dialect)];
}

const char* dialect_name(Dialect dialect) {
  return dialect_row(dialect).name;
}

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const DialectRow& row : kDialects) names.emplace_back(row.name);
  return names;
}

std::string dialect_list(const char* last) {
  std::string list;
  for (const DialectRow& row : kDialects) {
    if (&row != kDialects.data()) list += &row == &kDialects.back() ? last : ", ";
    list += row.name;
  }
  return list;
}

std::optional<Dialect> dialect_of(std::string_view name) {
  for (const DialectRow& row : kDialects) {
    if (name == row.name) return row.dialect;
  }
  return std::nullopt;
}

bool is_dialect_ending(std::string_view extension) {
  return std::any_of(kDialects.begin(), kDialects.end(), [&](const DialectRow& row) {
    return std::find(row.endings.begin(), row.endings.end(), extension) != row.endings.end();
  });
}

}  // namespace swarf::program
