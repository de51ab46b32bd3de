#include "crashrank/base/view.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace crashrank {
namespace {

using Ints = Column<int>;

// Memory of somebody else, with a count of who keeps it.
struct Shelf {
  std::shared_ptr<const std::array<int, 4>> memory =
      std::make_shared<const std::array<int, 4>>(std::array<int, 4>{5, 6, 7, 8});
  Ints column() const { return Ints::borrow({memory->data(), memory->size()}, memory); }
};

TEST(Column, GrowsShrinksAndComparesAsAVector) {
  Ints column{1, 2, 3};
  column.push_back(4);
  column.emplace_back(5);
  EXPECT_EQ(column, (Ints{1, 2, 3, 4, 5}));
  column.pop_back();
  column.erase(column.begin(), column.begin() + 1);
  EXPECT_EQ(column, (Ints{2, 3, 4}));
  const std::vector<int> more{8, 9};
  EXPECT_EQ(*column.insert(column.begin() + 1, more.begin(), more.end()), 8);
  EXPECT_EQ(column, (Ints{2, 8, 9, 3, 4}));
  column.resize(2);
  column.resize(4, 7);
  EXPECT_EQ(column, (Ints{2, 8, 7, 7}));
  column.assign(2, 1);
  EXPECT_EQ(column, (Ints{1, 1}));
  column = {3};
  EXPECT_EQ(column.front() + column.back() + column[0], 9);
  EXPECT_NE(column, (Ints{3, 3}));
  column.clear();
  EXPECT_TRUE(column.empty());
  EXPECT_EQ(Ints(3).size(), 3U);
}

TEST(Column, ReadsBorrowedMemoryInPlace) {
  const Shelf shelf;
  const Ints column = shelf.column();
  EXPECT_TRUE(column.borrowed());
  EXPECT_EQ(column.data(), shelf.memory->data());
  EXPECT_EQ(column, (Ints{5, 6, 7, 8}));
  EXPECT_EQ(View<const int>(column).data(), shelf.memory->data());
}

TEST(Column, CopiesBorrowedMemoryOnTheFirstChangeOnly) {
  const Shelf shelf;
  Ints changed = shelf.column();
  const Ints other = changed;
  EXPECT_EQ(other.data(), shelf.memory->data()) << "a copy borrows as well";
  changed[1] = 60;
  EXPECT_FALSE(changed.borrowed());
  EXPECT_EQ(changed, (Ints{5, 60, 7, 8}));
  EXPECT_EQ(other, (Ints{5, 6, 7, 8}));
  EXPECT_EQ((*shelf.memory)[1], 6);
  const int* const place = changed.data();
  changed[2] = 70;
  EXPECT_EQ(std::as_const(changed).data(), place);

  using Change = void (*)(Ints&);
  const std::vector<std::pair<Change, Ints>> changes{
      {[](Ints& c) { c.push_back(9); }, {5, 6, 7, 8, 9}},
      {[](Ints& c) { c.pop_back(); }, {5, 6, 7}},
      {[](Ints& c) { c.resize(1); }, {5}},
      {[](Ints& c) { c.clear(); }, {}},
      {[](Ints& c) { c.assign(1, 2); }, {2}},
      {[](Ints& c) { c = {4}; }, {4}},
      {[](Ints& c) { c.reserve(100); }, {5, 6, 7, 8}},
      {[](Ints& c) { c.back() = 1; }, {5, 6, 7, 1}},
      {[](Ints& c) {
         for (int& value : c) ++value;
       },
       {6, 7, 8, 9}},
      {[](Ints& c) {
         c.insert(std::as_const(c).begin() + 2, {0, 0});
       },
       {5, 6, 0, 0, 7, 8}},
      {[](Ints& c) { c.erase(std::as_const(c).begin(), std::as_const(c).end()); }, {}},
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Ints column = shelf.column();
    changes[i].first(column);
    EXPECT_EQ(column, changes[i].second) << i;
    EXPECT_FALSE(column.borrowed()) << i;
    EXPECT_EQ(*shelf.memory, (std::array<int, 4>{5, 6, 7, 8})) << i;
  }
}

TEST(Column, KeepsTheMemoryForAsLongAsItReadsIt) {
  std::weak_ptr<const std::array<int, 4>> watched;
  Ints last;
  {
    const Shelf shelf;
    watched = shelf.memory;
    const Ints first = shelf.column();
    last = first;
  }
  EXPECT_FALSE(watched.expired());
  EXPECT_EQ(last.back(), 8);
  last.push_back(1);
  EXPECT_TRUE(watched.expired()) << "its own copy needs nobody's memory";
}

TEST(Column, MovesLeaveAnEmptyColumn) {
  const Shelf shelf;
  for (const bool borrowed : {false, true}) {
    Ints from = borrowed ? shelf.column() : Ints{5, 6, 7, 8};
    Ints to = std::move(from);
    EXPECT_EQ(to, (Ints{5, 6, 7, 8}));
    EXPECT_TRUE(from.empty());  // NOLINT(bugprone-use-after-move): promised
    EXPECT_FALSE(from.borrowed());
    from.push_back(1);
    EXPECT_EQ(from, (Ints{1}));
    from = std::move(to);
    EXPECT_EQ(from, (Ints{5, 6, 7, 8}));
    EXPECT_TRUE(to.empty());  // NOLINT(bugprone-use-after-move): promised
    Ints& same = from;
    from = same;
    EXPECT_EQ(from, (Ints{5, 6, 7, 8}));
    EXPECT_EQ(from.borrowed(), borrowed);
  }
}

TEST(Column, KeepsTheAlignmentOfItsValues) {
  struct alignas(64) Line {
    std::array<std::uint32_t, 16> value;
  };
  Column<Line> lines;
  for (int i = 0; i < 100; ++i) {
    lines.emplace_back();
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(lines.data()) % 64, 0U);
  }
}

}  // namespace
}  // namespace crashrank
