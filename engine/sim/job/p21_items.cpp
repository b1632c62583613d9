#include "sim/job/p21_items.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "sim/job/part21.h"

namespace swarf::sim {
namespace {

/// DC, RE, LF_2: a capital, then capitals, digits and _.
bool is_symbol(const std::string& text) {
  return !text.empty() && std::isupper(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_';
         });
}

class P21Properties {
 public:
  explicit P21Properties(const P21Records& records) : records_(records) {}

  P21Items run() {
    for (const auto& [id, record] : records_) {
      if (record.name == "PROPERTY_VALUE_ASSOCIATION") read_association(record);
    }
    for (auto& [id, item] : items_) found_.items.push_back(std::move(item));
    return std::move(found_);
  }

 private:
  const P21Record* at(int64_t id) const {
    const auto found = records_.find(id);
    return found == records_.end() ? nullptr : &found->second;
  }

  /// The first that a record refers to by one of its arguments; null: none.
  const P21Record* referred(const P21Record& from, const char* name) const {
    for (const int64_t id : from.refs) {
      const P21Record* to = at(id);
      if (to != nullptr && to->name == name) return to;
    }
    return nullptr;
  }

  /// From what an association describes to the item; the record itself where none is behind it.
  int64_t item_of(int64_t id) const {
    constexpr int kSteps = 4;  // definition, version, item
    for (int i = 0; i < kSteps; ++i) {
      const P21Record* record = at(id);
      if (record == nullptr || record->name == "ITEM") break;
      const auto next = std::find_if(record->refs.begin(), record->refs.end(), [&](int64_t ref) {
        const P21Record* to = at(ref);
        return to != nullptr && (to->name == "ITEM" || to->name == "ITEM_VERSION");
      });
      if (next == record->refs.end()) break;
      id = *next;
    }
    return id;
  }

  static std::optional<double> number_of(const P21Record& value) {
    if (value.texts.size() < 2)
      return value.numbers.empty() ? std::nullopt : std::optional(value.numbers.back());
    const std::string& text = value.texts.back();
    double number = 0.0;
    const auto [next, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    return failure == std::errc() && next == text.data() + text.size() ? std::optional(number) : std::nullopt;
  }

  /// "" where only the code in a dictionary says what it is.
  static std::string symbol_of(const P21Record* property, const P21Record& value) {
    if (!value.texts.empty() && is_symbol(value.texts.front())) return value.texts.front();
    if (property != nullptr && !property->texts.empty() && is_symbol(property->texts.front()))
      return property->texts.front();
    return "";
  }

  void read_association(const P21Record& association) {
    const P21Record* representation = referred(association, "PROPERTY_VALUE_REPRESENTATION");
    if (representation == nullptr) return;
    const P21Record* value = referred(*representation, "NUMERICAL_VALUE");
    if (value == nullptr) return;
    const P21Record* property = referred(*representation, "PROPERTY");
    const std::string symbol = symbol_of(property, *value);
    if (symbol.empty()) return add_code(property);
    const std::optional<double> number = number_of(*value);
    if (!number || !std::isfinite(*number)) return;
    const P21Record* unit = referred(*value, "UNIT");
    add(association, symbol, {*number, unit == nullptr || unit->texts.empty() ? "" : unit->texts.front()});
  }

  void add(const P21Record& association, const std::string& symbol, const P21Value& value) {
    for (const int64_t ref : association.refs) {
      const P21Record* described = at(ref);
      if (described == nullptr || described->name == "PROPERTY_VALUE_REPRESENTATION") continue;
      const int64_t id = item_of(ref);
      const P21Record& record = *at(id);
      P21Item& item = items_[id];
      item.line = record.line;
      if (record.name == "ITEM" && !record.texts.empty()) item.id = record.texts.front();
      const auto [there, fresh] = item.values.emplace(symbol, value);
      if (!fresh && (there->second.value != value.value || there->second.unit != value.unit))
        there->second.contradicts = true;
    }
  }

  void add_code(const P21Record* property) {
    const P21Record* plib = property == nullptr ? nullptr : referred(*property, "PLIB_PROPERTY_REFERENCE");
    if (plib != nullptr && !plib->texts.empty()) found_.codes.insert(plib->texts.front());
  }

  const P21Records& records_;
  std::map<int64_t, P21Item> items_;
  P21Items found_;
};

}  // namespace

P21Items read_p21_items(const std::string& path) {
  const P21Records records = read_part21(path);
  return P21Properties(records).run();
}

}  // namespace swarf::sim
