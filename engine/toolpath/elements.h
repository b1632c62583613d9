// The elements of a path by number. A program has millions of blocks of which most of what they say is the
// same as in the block before, so blocks are kept packed:
//
//   kChunk blocks     tip xyz | axis ijk | q1 .. q5 | feed | duration | kind | line | column
//                     one value for the chunk where all are the same, else one for each block
//   kinds             what few blocks differ in: law, tool, spindle, pass, ...
//   aside, by number  arcs, stretches of curves; starts that are not, to the last bit, where the block before
//   has ended
//
// A block of a three-axis finish takes about 70 bytes so; the Element that it is given out as, 368.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/index_iterator.h"
#include "toolpath/element.h"

namespace swarf::toolpath {

/// Copies share what they hold until one of them is added to.
class Elements {
 public:
  Elements() = default;
  explicit Elements(const std::vector<Element>& elements);

  /// A path holds blocks or other elements, not both.
  void push_back(Element element);
  /// Blocks [begin, end) of another path of blocks, as they are packed there: equal to pushing each of them.
  void append(const Elements& other, size_t begin, size_t end);
  /// Replaces the names of the files that SourceLocation::file says; `name` of each different one.
  template <typename Name>
  void rename_files(const Name& name) {
    for (std::string& file : own().files) file = name(file);
  }

  size_t size() const;
  bool empty() const { return size() == 0; }
  /// Blocks and nothing else, at least one.
  bool hold_blocks() const { return !data_->kinds.empty(); }

  /// Made anew: equal to what was added, to the last bit.
  Element operator[](size_t i) const;
  Element back() const { return (*this)[size() - 1]; }
  auto begin() const { return IndexIterator(*this, 0); }
  auto end() const { return IndexIterator(*this, size()); }
  /// Null: this element is none. Valid until something is added.
  const SurfacePass* pass(size_t i) const;
  const DrivenPass* driven(size_t i) const;

  SourceLocation where(size_t i) const;
  int line(size_t i) const;

  // Of a path of blocks:
  BlockMove block(size_t i) const;
  ToolPose block_end(size_t i) const;  ///< BlockMove::to
  double feed_mm_s(size_t i) const;
  bool is_rapid(size_t i) const;  ///< is_rapid(block(i))
  int tool(size_t i) const;
  bool all_give_axes() const;  ///< BlockMove::axes

  /// Memory that is held.
  size_t bytes() const;

 private:
  static constexpr size_t kChunk = 1024;
  enum Number { kTip = 0, kAxis = 3, kValues = 6, kFeed = 11, kDuration, kNumbers };
  enum Count { kKind, kLine, kColumn, kCounts };

  /// What a block says of its own.
  struct Row {
    std::array<double, kNumbers> number{};
    std::array<int32_t, kCounts> count{};
    ToolPose pose() const;
    kinematics::AxisValues values() const;
  };
  /// What it has in common with others.
  struct Kind {
    BlockLaw law = BlockLaw::kTcp;
    double dwell_s = 0.0, corner_tolerance_mm = 0.0;
    std::optional<double> spindle_rpm;
    int tool = 0, pass = -1, operation = 0;
    uint32_t file = 0;
    bool exact_stop = false;
    bool has_axes = false, has_arc = false, has_curve = false;
    bool starts = false;  ///< its start is not the end of the block before
    bool operator==(const Kind&) const = default;
  };
  struct Start {
    size_t element = 0;
    ToolPose pose;
    kinematics::AxisValues q;
  };
  struct Arc {
    size_t element = 0;
    program::Arc arc;
  };
  struct Curve {
    size_t element = 0;
    CurveSpan span;
  };
  /// One value of each block of a chunk.
  template <typename T>
  class Column {
   public:
    Column() = default;
    template <typename Get>
    Column(size_t size, const Get& get);
    T at(size_t i) const { return values_ ? values_[i] : same_; }
    bool is_same() const { return !values_; }

   private:
    T same_{};
    std::unique_ptr<T[]> values_;
  };
  struct Chunk {
    std::array<Column<double>, kNumbers> number;
    std::array<Column<int32_t>, kCounts> count;
    explicit Chunk(const std::vector<Row>& rows);
    size_t bytes() const;
  };
  struct Data {
    std::vector<Element> plain;  ///< of a path that holds no blocks
    std::vector<std::shared_ptr<const Chunk>> chunks;
    std::vector<Row> open;  ///< the last blocks, less than a chunk
    std::vector<Kind> kinds;
    std::vector<Start> starts;
    std::vector<Arc> arcs;
    std::vector<Curve> curves;
    std::vector<std::string> files;
  };

  Data& own();
  void add_block(const Element& element, const BlockMove& block);
  void add_row(const Row& row);
  Row row(size_t i) const;
  int32_t count(size_t i, Count which) const;
  double number(size_t i, Number which) const;
  const Kind& kind(size_t i) const { return data_->kinds[static_cast<size_t>(count(i, kKind))]; }
  static Row row_of(const BlockMove& block);
  static int32_t number_of(Data& data, const Kind& kind);
  static uint32_t number_of(Data& data, const std::string& file);

  std::shared_ptr<Data> data_ = std::make_shared<Data>();
};

}  // namespace swarf::toolpath
