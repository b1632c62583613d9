#include "toolpath/elements.h"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

#include "base/check.h"

namespace swarf::toolpath {
namespace {

/// Kinds alternate, between rapids and feeds for example: so many of the last ones are looked through.
constexpr size_t kKindsBack = 8;

/// To the last bit: zeros of two signs differ.
template <typename T>
bool same_bits(const T& a, const T& b) {
  if constexpr (std::is_floating_point_v<T>) {
    static_assert(sizeof(T) == sizeof(uint64_t));
    return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
  } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    return a == b;
  } else {
    return std::equal(a.data(), a.data() + a.size(), b.data(),
                      [](double x, double y) { return same_bits(x, y); });
  }
}

template <typename List>
const auto& entry_of(const List& list, size_t element) {
  const auto found = std::lower_bound(list.begin(), list.end(), element,
                                      [](const auto& entry, size_t i) { return entry.element < i; });
  return *found;
}

}  // namespace

ToolPose Elements::Row::pose() const {
  return {Vec3::Map(&number[kTip]), Vec3::Map(&number[kAxis])};
}

kinematics::AxisValues Elements::Row::values() const {
  return kinematics::AxisValues::Map(&number[kValues]);
}

template <typename T>
template <typename Get>
Elements::Column<T>::Column(size_t size, const Get& get) : same_(get(0)) {
  bool differs = false;
  for (size_t i = 1; i < size && !differs; ++i) differs = !same_bits(get(i), same_);
  if (!differs) return;
  values_ = std::make_unique<T[]>(size);
  for (size_t i = 0; i < size; ++i) values_[i] = get(i);
}

Elements::Chunk::Chunk(const std::vector<Row>& rows) {
  for (size_t k = 0; k < kNumbers; ++k)
    number[k] = Column<double>(rows.size(), [&](size_t i) { return rows[i].number[k]; });
  for (size_t k = 0; k < kCounts; ++k)
    count[k] = Column<int32_t>(rows.size(), [&](size_t i) { return rows[i].count[k]; });
}

size_t Elements::Chunk::bytes() const {
  size_t sum = sizeof(Chunk);
  for (const auto& column : number) sum += column.is_same() ? 0 : kChunk * sizeof(double);
  for (const auto& column : count) sum += column.is_same() ? 0 : kChunk * sizeof(int32_t);
  return sum;
}

Elements::Elements(const std::vector<Element>& elements) {
  for (const Element& element : elements) push_back(element);
}

Elements::Data& Elements::own() {
  if (data_.use_count() > 1) data_ = std::make_shared<Data>(*data_);
  return *data_;
}

void Elements::push_back(Element element) {
  if (const auto* block = std::get_if<BlockMove>(&element.what)) {
    SWARF_CHECK(data_->plain.empty(), "a path holds blocks or other elements");
    add_block(element, *block);
  } else {
    SWARF_CHECK(data_->kinds.empty(), "a path holds blocks or other elements");
    own().plain.push_back(std::move(element));
  }
}

Elements::Row Elements::row_of(const BlockMove& block) {
  Row row;
  Vec3::Map(&row.number[kTip]) = block.to.tip_W;
  Vec3::Map(&row.number[kAxis]) = block.to.axis_W;
  if (block.axes) kinematics::AxisValues::Map(&row.number[kValues]) = block.axes->to;
  row.number[kFeed] = block.feed_mm_s;
  row.number[kDuration] = block.duration_s;
  return row;
}

void Elements::add_block(const Element& element, const BlockMove& block) {
  const size_t i = size();
  Kind kind{block.law,
            block.dwell_s,
            block.corner_tolerance_mm,
            block.spindle_rpm,
            block.tool,
            block.pass,
            element.operation,
            0,
            block.exact_stop,
            block.axes.has_value(),
            block.arc.has_value(),
            block.curve.has_value(),
            true};
  if (i > 0) {
    const Row before = row(i - 1);
    const ToolPose pose = before.pose();
    const bool same_axes =
        !block.axes || (this->kind(i - 1).has_axes && same_bits(before.values(), block.axes->from));
    kind.starts =
        !same_axes || !same_bits(pose.tip_W, block.from.tip_W) || !same_bits(pose.axis_W, block.from.axis_W);
  }
  Data& data = own();
  kind.file = number_of(data, element.where.file);
  if (kind.has_arc) data.arcs.push_back({i, *block.arc});
  if (kind.has_curve) data.curves.push_back({i, *block.curve});
  if (kind.starts) {
    const kinematics::AxisValues none = kinematics::AxisValues::Zero();
    data.starts.push_back({i, block.from, block.axes ? block.axes->from : none});
  }
  Row row = row_of(block);
  row.count = {number_of(data, kind), element.where.line, element.where.column};
  add_row(row);
}

void Elements::add_row(const Row& row) {
  Data& data = *data_;
  if (data.open.capacity() == 0) data.open.reserve(kChunk);
  data.open.push_back(row);
  if (data.open.size() < kChunk) return;
  data.chunks.push_back(std::make_shared<const Chunk>(data.open));
  data.open.clear();
}

void Elements::append(const Elements& other, size_t begin, size_t end) {
  if (begin == end) return;
  SWARF_CHECK(other.hold_blocks() && end <= other.size(), "blocks of the other path");
  push_back(other[begin]);  // its start may have to be said here
  Data& data = own();
  std::vector<int32_t> kinds(other.data_->kinds.size(), -1);  // numbers here of those there
  for (size_t i = begin + 1; i < end; ++i) {
    Row row = other.row(i);
    const auto there = static_cast<size_t>(row.count[kKind]);
    if (kinds[there] < 0) {
      Kind kind = other.data_->kinds[there];
      kind.file = number_of(data, other.data_->files[kind.file]);
      kinds[there] = number_of(data, kind);
    }
    row.count[kKind] = kinds[there];
    const Kind& kind = data.kinds[static_cast<size_t>(kinds[there])];
    if (kind.has_arc) data.arcs.push_back({size(), entry_of(other.data_->arcs, i).arc});
    if (kind.has_curve) data.curves.push_back({size(), entry_of(other.data_->curves, i).span});
    if (kind.starts) {
      const Start& start = entry_of(other.data_->starts, i);
      data.starts.push_back({size(), start.pose, start.q});
    }
    add_row(row);
  }
}

int32_t Elements::number_of(Data& data, const Kind& kind) {
  const size_t first = data.kinds.size() - std::min(data.kinds.size(), kKindsBack);
  for (size_t i = data.kinds.size(); i > first; --i)
    if (data.kinds[i - 1] == kind) return static_cast<int32_t>(i - 1);
  data.kinds.push_back(kind);
  return static_cast<int32_t>(data.kinds.size() - 1);
}

uint32_t Elements::number_of(Data& data, const std::string& file) {
  const auto found = std::find(data.files.rbegin(), data.files.rend(), file);
  if (found != data.files.rend()) return static_cast<uint32_t>(data.files.rend() - found - 1);
  data.files.push_back(file);
  return static_cast<uint32_t>(data.files.size() - 1);
}

size_t Elements::size() const {
  return data_->plain.size() + data_->chunks.size() * kChunk + data_->open.size();
}

Elements::Row Elements::row(size_t i) const {
  const size_t chunk = i / kChunk, at = i % kChunk;
  if (chunk == data_->chunks.size()) return data_->open[at];
  const Chunk& held = *data_->chunks[chunk];
  Row row;
  for (size_t k = 0; k < kNumbers; ++k) row.number[k] = held.number[k].at(at);
  for (size_t k = 0; k < kCounts; ++k) row.count[k] = held.count[k].at(at);
  return row;
}

int32_t Elements::count(size_t i, Count which) const {
  const size_t chunk = i / kChunk;
  if (chunk == data_->chunks.size()) return data_->open[i % kChunk].count[which];
  return data_->chunks[chunk]->count[which].at(i % kChunk);
}

BlockMove Elements::block(size_t i) const {
  SWARF_CHECK(hold_blocks() && i < size(), "a block of the path");
  const Row row = this->row(i);
  const Kind& kind = data_->kinds[static_cast<size_t>(row.count[kKind])];
  BlockMove block;
  block.to = row.pose();
  if (kind.has_axes) block.axes = AxisSpan{kinematics::AxisValues::Zero(), row.values()};
  if (kind.starts) {
    const Start& start = entry_of(data_->starts, i);
    block.from = start.pose;
    if (block.axes) block.axes->from = start.q;
  } else {
    const Row before = this->row(i - 1);
    block.from = before.pose();
    if (block.axes) block.axes->from = before.values();
  }
  if (kind.has_arc) block.arc = entry_of(data_->arcs, i).arc;
  if (kind.has_curve) block.curve = entry_of(data_->curves, i).span;
  block.law = kind.law;
  block.feed_mm_s = row.number[kFeed];
  block.duration_s = row.number[kDuration];
  block.dwell_s = kind.dwell_s;
  block.exact_stop = kind.exact_stop;
  block.corner_tolerance_mm = kind.corner_tolerance_mm;
  block.spindle_rpm = kind.spindle_rpm;
  block.tool = kind.tool;
  block.pass = kind.pass;
  return block;
}

Element Elements::operator[](size_t i) const {
  if (!hold_blocks()) return data_->plain[i];
  return {block(i), kind(i).operation, where(i)};
}

const SurfacePass* Elements::pass(size_t i) const {
  return hold_blocks() ? nullptr : std::get_if<SurfacePass>(&data_->plain[i].what);
}

const DrivenPass* Elements::driven(size_t i) const {
  return hold_blocks() ? nullptr : std::get_if<DrivenPass>(&data_->plain[i].what);
}

SourceLocation Elements::where(size_t i) const {
  if (!hold_blocks()) return data_->plain[i].where;
  return {data_->files[kind(i).file], count(i, kLine), count(i, kColumn)};
}

int Elements::line(size_t i) const {
  return hold_blocks() ? count(i, kLine) : data_->plain[i].where.line;
}

ToolPose Elements::block_end(size_t i) const {
  return row(i).pose();
}

double Elements::number(size_t i, Number which) const {
  const size_t chunk = i / kChunk;
  if (chunk == data_->chunks.size()) return data_->open[i % kChunk].number[which];
  return data_->chunks[chunk]->number[which].at(i % kChunk);
}

double Elements::feed_mm_s(size_t i) const {
  return number(i, kFeed);
}

bool Elements::is_rapid(size_t i) const {
  return number(i, kFeed) == 0.0 && number(i, kDuration) == 0.0;
}

int Elements::tool(size_t i) const {
  return kind(i).tool;
}

bool Elements::all_give_axes() const {
  return std::all_of(data_->kinds.begin(), data_->kinds.end(),
                     [](const Kind& kind) { return kind.has_axes; });
}

size_t Elements::bytes() const {
  size_t sum = data_->plain.capacity() * sizeof(Element) + data_->open.capacity() * sizeof(Row) +
               data_->kinds.capacity() * sizeof(Kind) + data_->starts.capacity() * sizeof(Start) +
               data_->arcs.capacity() * sizeof(Arc) + data_->curves.capacity() * sizeof(Curve);
  for (const auto& chunk : data_->chunks) sum += chunk->bytes();
  return sum;
}

}  // namespace swarf::toolpath
