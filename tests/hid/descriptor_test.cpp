#include "gaitpad/descriptor.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/value_of.h"

namespace gaitpad {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A descriptor with one application collection around the items.
Bytes game_pad(const Bytes& items) {
  return Bytes{0x05, 0x01, 0x09, 0x05, 0xa1, 0x01} + items + Bytes{0xc0};
}

ReportDescriptor parsed(const Bytes& bytes) { return value_of(parse_descriptor(bytes)); }
std::string cause(const Bytes& bytes) { return cause_of(parse_descriptor(bytes)); }

// The field of X with 8 bits and these range items.
Field x_with_range(const Bytes& range, std::uint8_t bits = 8) {
  const auto d = parsed(game_pad(range + Bytes{0x09, 0x30, 0x75, bits, 0x95, 0x01, 0x81, 0x02}));
  EXPECT_EQ(d.fields.size(), 1u);
  return d.fields.empty() ? Field{} : d.fields.front();
}

TEST(ReportDescriptor, LogicalMaximumIsSignedOnlyIfTheMinimumIsNegative) {
  EXPECT_EQ(x_with_range({0x15, 0x00, 0x25, 0xff}).logical_max, 255);
  EXPECT_EQ(x_with_range({0x15, 0x00, 0x26, 0xff, 0xff}, 16).logical_max, 65535);
  EXPECT_EQ(x_with_range({0x15, 0x00, 0x27, 0xff, 0xff, 0xff, 0xff}, 32).logical_max, 4294967295);
  EXPECT_EQ(x_with_range({0x15, 0x81, 0x25, 0x7f}).logical_min, -127);
  EXPECT_EQ(x_with_range({0x15, 0x80, 0x25, 0xff}).logical_max, -1);
  EXPECT_EQ(x_with_range({0x16, 0x00, 0x80, 0x26, 0xff, 0x7f}, 16).logical_min, -32768);
}

TEST(ReportDescriptor, TheOrderOfMinimumAndMaximumDoesNotMatter) {
  const Field f = x_with_range({0x25, 0xff, 0x15, 0x80});
  EXPECT_EQ(f.logical_min, -128);
  EXPECT_EQ(f.logical_max, -1);
}

TEST(ReportDescriptor, MinimumAboveMaximumFallsBackToTheBitsAndIsFlagged) {
  const Field f = x_with_range({0x15, 0x10, 0x25, 0x01});
  EXPECT_TRUE(f.has_odd_range);
  EXPECT_EQ(f.logical_min, 0);
  EXPECT_EQ(f.logical_max, 255);
}

TEST(ReportDescriptor, ItemWithoutDataMeansZero) {
  EXPECT_EQ(x_with_range({0x15, 0x10, 0x14, 0x25, 0x7f}).logical_min, 0);
}

TEST(ReportDescriptor, ValuesAreSignExtendedOnlyIfTheMinimumIsNegative) {
  Field f = x_with_range({0x15, 0x81, 0x25, 0x7f});
  EXPECT_EQ(field_value(f, Bytes{0xff}), -1);
  f = x_with_range({0x15, 0x00, 0x25, 0xff});
  EXPECT_EQ(field_value(f, Bytes{0xff}), 255);
}

TEST(ReportDescriptor, FieldsCrossByteBorders) {
  // Two 12-bit values packed as the Switch does: 0x123, 0xabc.
  const Bytes data = {0x23, 0xc1, 0xab};
  EXPECT_EQ(bits_at(data, 0, 12), 0x123u);
  EXPECT_EQ(bits_at(data, 12, 12), 0xabcu);
  EXPECT_EQ(bits_at(data, 20, 12), 0x00au) << "bits behind the data are 0";
}

TEST(ReportDescriptor, UsageRangeGivesEachFieldItsOwnUsage) {
  const auto d = parsed(game_pad({0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15, 0x00, 0x25, 0x01, 0x75,
                                  0x01, 0x95, 0x04, 0x81, 0x02}));
  ASSERT_EQ(d.fields.size(), 4u);
  EXPECT_EQ(d.fields[0].usage, 0x00090001u);
  EXPECT_EQ(d.fields[2].usage, 0x00090003u);
  EXPECT_EQ(d.fields[3].usage, 0x00090003u) << "the last usage serves the rest";
  EXPECT_EQ(d.fields[3].bit_offset, 3u);
}

TEST(ReportDescriptor, UsagesTakeTheirPages) {
  const auto usages = [](const Bytes& bytes) {
    std::vector<std::uint32_t> all;
    for (const Field& field : parsed(bytes).fields) all.push_back(field.usage);
    return all;
  };
  using Usages = std::vector<std::uint32_t>;
  const Bytes two = {0x25, 0x7f, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02};
  // The usage maximum may precede the minimum.
  EXPECT_EQ(usages(game_pad(Bytes{0x05, 0x09, 0x29, 0x02, 0x19, 0x01} + two)),
            (Usages{0x00090001, 0x00090002}));
  // The Asus pad: X, then page 2 with Brake: X takes the page in force at its place.
  EXPECT_EQ(usages(game_pad(Bytes{0x09, 0x30, 0x05, 0x02, 0x09, 0xc5} + two)),
            (Usages{usage::kX, usage::kBrake}));
  // A page after the last usage applies to the usages before it,
  EXPECT_EQ(usages(game_pad(Bytes{0x05, 0x0c, 0x09, 0x30, 0x09, 0x31, 0x05, 0x01} + two)),
            (Usages{usage::kX, usage::kY}));
  // but not to usages that are on that page already. Usages: page 2: c5; page 1: 30; page 0c: 40;
  // then page 1 follows.
  EXPECT_EQ(usages(game_pad({0x05, 0x02, 0x09, 0xc5, 0x05, 0x01, 0x09, 0x30, 0x05, 0x0c, 0x09,
                             0x40, 0x05, 0x01, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x03, 0x81, 0x02})),
            (Usages{usage::kBrake, usage::kX, 0x00010040}));
  // A usage of four bytes contains its page.
  const Bytes four = {0x05, 0x0c, 0x0b, 0x04, 0x00, 0x01, 0x00, 0xa1, 0x01, 0x0b, 0x30, 0x00,
                      0x01, 0x00, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02, 0xc0};
  EXPECT_EQ(parsed(four).applications[0], usage::kJoystick);
  EXPECT_EQ(usages(four), Usages{usage::kX});
}

TEST(ReportDescriptor, PopBringsBackWhatPushKept) {
  const auto d =
      parsed(game_pad({0x15, 0x00, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0xa4, 0x25, 0x01,
                       0x75, 0x01, 0x09, 0x31, 0x81, 0x02, 0xb4, 0x09, 0x30, 0x81, 0x02}));
  EXPECT_EQ(d.fields[0].bit_size, 1u);
  EXPECT_EQ(d.fields[1].bit_size, 8u);
  EXPECT_EQ(d.fields[1].logical_max, 127);
  EXPECT_EQ(d.fields[1].bit_offset, 1u) << "the place in the report is no global item";
}

TEST(ReportDescriptor, EachReportIdHasItsOwnOffsetsAndKinds) {
  const auto d = parsed(game_pad({0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0x85, 0x01, 0x09, 0x30,
                                  0x81, 0x02, 0x85, 0x02, 0x09, 0x31, 0x81, 0x02, 0x09, 0x32,
                                  0x91, 0x02, 0x85, 0x01, 0x09, 0x33, 0x81, 0x02}));
  EXPECT_TRUE(d.numbered);
  EXPECT_EQ(d.fields[1].bit_offset, 0u);
  EXPECT_EQ(d.fields[2].kind, FieldKind::output);
  EXPECT_EQ(d.fields[2].bit_offset, 0u);
  EXPECT_EQ(d.fields[3].bit_offset, 8u);
  EXPECT_EQ(report_bytes(d, FieldKind::input, 1), 3u) << "the id counts";
  EXPECT_EQ(report_bytes(d, FieldKind::input, 9), 0u);
}

TEST(ReportDescriptor, ConstantFieldsTakeRoomButAreLeftOut) {
  const auto d = parsed(game_pad({0x25, 0x01, 0x75, 0x03, 0x95, 0x02, 0x81, 0x03, 0x09, 0x30, 0x75,
                                  0x08, 0x95, 0x01, 0x81, 0x02}));
  ASSERT_EQ(d.fields.size(), 1u);
  EXPECT_EQ(d.fields[0].bit_offset, 6u);
}

TEST(ReportDescriptor, FieldsWithoutBitsAreInert) {
  const auto d = parsed(game_pad({0x09, 0x30, 0x25, 0x01, 0x75, 0x00, 0x95, 0xff, 0x81, 0x02}));
  EXPECT_TRUE(d.fields.empty());
  EXPECT_EQ(report_bytes(d, FieldKind::input, 0), 0u);
}

TEST(ReportDescriptor, ArrayValuesNameUsages) {
  const auto d = parsed(game_pad({0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x09, 0x20, 0x15, 0x01, 0x25,
                                  0x04, 0x75, 0x08, 0x95, 0x02, 0x81, 0x00}));
  ASSERT_EQ(d.fields.size(), 2u);
  EXPECT_TRUE(d.fields[0].is_array);
  EXPECT_EQ(array_usage(d, d.fields[0], 1), 0x00090001u);
  EXPECT_EQ(array_usage(d, d.fields[1], 4), 0x00090020u);
  EXPECT_EQ(array_usage(d, d.fields[0], 0), 0u) << "outside the range: none";
  EXPECT_EQ(array_usage(d, d.fields[0], 5), 0u);
}

TEST(ReportDescriptor, OnlyTheFirstDelimiterSetCounts) {
  const auto d = parsed(game_pad({0xa9, 0x01, 0x09, 0x30, 0xa9, 0x00, 0xa9, 0x01, 0x09, 0x38,
                                  0xa9, 0x00, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02}));
  ASSERT_EQ(d.fields.size(), 1u);
  EXPECT_EQ(d.fields[0].usage, usage::kX);
}

TEST(ReportDescriptor, LongItemsAreSkipped) {
  const auto d = parsed(game_pad(
      {0xfe, 0x02, 0xf0, 0xc0, 0xc0, 0x09, 0x30, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02}));
  EXPECT_EQ(d.fields.size(), 1u);
}

TEST(ReportDescriptor, TrailingNulIsNoHarm) {
  EXPECT_EQ(cause(game_pad({}) + Bytes{0x00}), "accepted");
}

TEST(ReportDescriptor, AFieldKnowsItsApplication) {
  const auto d = parsed(Bytes{0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x25,
                              0x7f, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0xc0} +
                        game_pad({0xa1, 0x00, 0x09, 0x30, 0x81, 0x02, 0xc0}));
  ASSERT_EQ(d.applications.size(), 2u);
  EXPECT_EQ(d.fields[0].application, 0);
  EXPECT_EQ(d.fields[2].application, 1) << "a physical collection inside changes nothing";
}

TEST(ReportDescriptor, APadIsAnApplicationOfTheRightKindWithBothAxes) {
  const Bytes both = {0x09, 0x30, 0x09, 0x31, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02};
  EXPECT_TRUE(pad_application(parsed(game_pad(both))));
  const Bytes only_x = {0x09, 0x30, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02};
  EXPECT_FALSE(pad_application(parsed(game_pad(only_x))));
  const Bytes as_output = {0x09, 0x30, 0x09, 0x31, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x02, 0x91, 0x02};
  EXPECT_FALSE(pad_application(parsed(game_pad(as_output))));
  Bytes mouse = game_pad(both);
  mouse[3] = 0x02;
  EXPECT_FALSE(pad_application(parsed(mouse)));
  for (const std::uint8_t kind : {0x04, 0x05, 0x08}) {
    mouse[3] = kind;
    EXPECT_TRUE(pad_application(parsed(mouse)));
  }
}

TEST(ReportDescriptor, LiesAreRefusedWithTheByte) {
  EXPECT_EQ(cause({}), "byte 0: the report descriptor is empty");
  EXPECT_EQ(cause({0x05}), "byte 0: the item runs over the end");
  EXPECT_EQ(cause({0x05, 0x01, 0x27, 0x00, 0x00, 0x00}), "byte 2: the item runs over the end");
  EXPECT_EQ(cause({0xfe}), "byte 0: the item runs over the end");
  EXPECT_EQ(cause({0xfe, 0x05, 0xf0, 0x00}), "byte 0: the item runs over the end");
  EXPECT_EQ(cause({0xc0}), "byte 0: the end of a collection that was not begun");
  EXPECT_EQ(cause({0xa1, 0x01}), "byte 2: 1 collections are not ended");
  EXPECT_EQ(cause({0xb4}), "byte 0: a pop without a push");
  EXPECT_EQ(cause({0xa4, 0xa4, 0xa4, 0xa4, 0xa4}), "byte 4: more than 4 pushes");
  EXPECT_EQ(cause({0x85, 0x00}), "byte 0: report id 0 is not within 1 .. 255");
  EXPECT_EQ(cause({0x86, 0x00, 0x01}), "byte 0: report id 256 is not within 1 .. 255");
  EXPECT_EQ(cause({0x76, 0x2c, 0x01}), "byte 0: report size of 300 bits, at most 256 are read");
  EXPECT_EQ(cause({0xa9, 0x01, 0xa9, 0x01}), "byte 2: a delimiter inside a delimiter");
  EXPECT_EQ(cause({0xa9, 0x00}), "byte 0: the end of a delimiter that was not begun");
  EXPECT_EQ(cause({0xa9, 0x01, 0x81, 0x02}), "byte 2: a delimiter is open at a main item");
  EXPECT_EQ(cause({0x19, 0x05, 0x29, 0x01}), "byte 2: usage minimum 0x5 is above the maximum 0x1");
  EXPECT_EQ(cause({0x19, 0x05, 0x75, 0x01, 0x95, 0x01, 0x81, 0x02}),
            "byte 6: a usage minimum without a usage maximum");
  EXPECT_EQ(cause({0x07, 0x00, 0x00, 0x01, 0x00}), "byte 0: usage page 0x10000 is above 0xffff");
}

TEST(ReportDescriptor, DeclaredCountsAllocateNothing) {
  // The descriptor claims 2^32 - 1 fields of 256 bits.
  EXPECT_EQ(cause({0x76, 0x00, 0x01, 0x97, 0xff, 0xff, 0xff, 0xff, 0x81, 0x02}),
            "byte 8: report 0 grows to 1099511627520 bits, at most 131072 are read");
  EXPECT_EQ(cause({0x75, 0x01, 0x97, 0xff, 0xff, 0x01, 0x00, 0x81, 0x02}),
            "byte 7: more than 32768 fields");
  EXPECT_EQ(cause({0x75, 0x00, 0x97, 0xff, 0xff, 0xff, 0xff, 0x81, 0x02}), "accepted")
      << "fields without bits";
  EXPECT_EQ(cause(Bytes(kMaxDescriptorBytes + 1, 0x00)),
            "byte 4096: the report descriptor has 4097 bytes, at most 4096 are read");
}

TEST(ReportDescriptor, ManyUsagesAreCappedAsInLinux) {
  Bytes items;
  for (int i = 0; i < 20; ++i) items = items + Bytes{0x1a, 0x00, 0x00, 0x2a, 0xff, 0xff};
  const auto d = parsed(game_pad(items + Bytes{0x25, 0x01, 0x75, 0x01, 0x95, 0x01, 0x81, 0x02}));
  EXPECT_EQ(d.fields.size(), 1u);
}

TEST(ReportDescriptor, CollectionsInsideEachOtherAreBounded) {
  Bytes deep;
  for (int i = 0; i < 65; ++i) deep = deep + Bytes{0xa1, 0x00};
  EXPECT_EQ(cause(deep), "byte 128: more than 64 collections inside each other");
}

}  // namespace
}  // namespace gaitpad
