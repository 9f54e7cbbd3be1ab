#include "files/toml_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <charconv>

#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

TomlFile parsed(const std::string& text) { return value_of(TomlFile::parse(text, "f.toml")); }
std::string syntax_error(const std::string& text) {
  auto file = TomlFile::parse(text, "f.toml");
  return file ? "none" : file.error().message;
}
std::string problem(const TomlFile& file) {
  const auto found = file.problem();
  return found ? found->message : "none";
}

TEST(TomlFile, TypedValuesArriveAsWritten) {
  TomlFile file = parsed(
      "a = 0.1\nb = 3\nc = true\nd = 'x'\ne = [1, 2.5]\nf = ['p', 'q']\n[g]\nh = 1\n[[i]]\nj = 1\n"
      "[[i]]\nj = 2\n");
  TomlTable root = file.root();
  EXPECT_EQ(root.number("a", 0, 1), 0.1);
  EXPECT_EQ(root.number("b", 0, 5), 3.0);
  EXPECT_EQ(root.integer("b", 0, 5), 3);
  EXPECT_EQ(root.boolean("c"), true);
  EXPECT_EQ(root.string("d"), "x");
  EXPECT_EQ(root.numbers("e", 2, 2, 0, 3), (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(root.strings("f", 2), (std::vector<std::string>{"p", "q"}));
  EXPECT_EQ(root.table("g")->integer("h", 0, 1), 1);
  auto tables = root.tables("i", 2);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].integer("j", 0, 9), 1);
  EXPECT_EQ(tables[1].integer("j", 0, 9), 2);
  EXPECT_EQ(problem(file), "none");
}

// Numbers have the same bits as from from_chars, because a replay depends on them.
TEST(TomlFile, NumbersAreTheNearestDoubles) {
  std::uint64_t seed = 1;
  for (int i = 0; i < 2'000; ++i) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    const std::string digits = "0." + std::to_string(seed);
    double expected = 0.0;
    std::from_chars(digits.data(), digits.data() + digits.size(), expected);
    TomlFile file = parsed("a = " + digits);
    ASSERT_EQ(file.root().number("a", 0, 1), expected) << digits;
  }
}

TEST(TomlFile, AbsentKeyIsNoProblemUntilItIsRequired) {
  TomlFile file = parsed("[t]\n");
  TomlTable root = file.root();
  EXPECT_FALSE(root.number("a", 0, 1));
  TomlTable table = *root.table("t");
  EXPECT_EQ(problem(file), "none");
  table.require("x");
  EXPECT_EQ(problem(file), "f.toml:1: key \"x\" is missing");
}

TEST(TomlFile, TheFirstUnknownKeyIsNamedWithItsLineAndTheNearestKnownOne) {
  TomlFile file = parsed("outer = 1\n\ninenr = 2\n");
  TomlTable root = file.root();
  root.number("inner", 0, 3);
  root.number("outer", 0, 3);
  EXPECT_EQ(problem(file), "f.toml:3: unknown key \"inenr\"; did you mean \"inner\"?");
  TomlFile far = parsed("banana = 1\n");
  far.root().number("inner", 0, 3);
  EXPECT_EQ(problem(far), "f.toml:1: unknown key \"banana\"");
  TomlFile nested = parsed("[t]\na = 1\nb = 2\n[u]\nc = 3\n");
  nested.root().table("t")->number("a", 0, 3);
  EXPECT_EQ(problem(nested).substr(0, 25), "f.toml:3: unknown key \"b\"");
}

TEST(TomlFile, WrongValuesNameLineAndCause) {
  const auto cause = [](const std::string& text, auto ask) {
    TomlFile file = parsed(text);
    TomlTable root = file.root();
    ask(root);
    return problem(file);
  };
  EXPECT_EQ(cause("\na = 2", [](TomlTable& t) { t.number("a", 0, 1); }),
            "f.toml:2: \"a\" is 2, outside [0, 1]");
  EXPECT_EQ(cause("a = nan", [](TomlTable& t) { t.number("a", 0, 1); }),
            "f.toml:1: \"a\" is nan, outside [0, 1]");
  EXPECT_EQ(cause("a = 'x'", [](TomlTable& t) { t.number("a", 0, 1); }),
            "f.toml:1: \"a\" is not a number");
  EXPECT_EQ(cause("a = 1.5", [](TomlTable& t) { t.integer("a", 0, 1); }),
            "f.toml:1: \"a\" is not a whole number");
  EXPECT_EQ(cause("a = 9", [](TomlTable& t) { t.integer("a", 0, 1); }),
            "f.toml:1: \"a\" is 9, outside [0, 1]");
  EXPECT_EQ(cause("a = 1", [](TomlTable& t) { t.boolean("a"); }),
            "f.toml:1: \"a\" is not true or false");
  EXPECT_EQ(cause("a = 1", [](TomlTable& t) { t.string("a"); }), "f.toml:1: \"a\" is not a string");
  EXPECT_EQ(cause("a = 1", [](TomlTable& t) { t.table("a"); }), "f.toml:1: \"a\" is not a table");
  EXPECT_EQ(cause("a = 1", [](TomlTable& t) { t.numbers("a", 1, 2, 0, 1); }),
            "f.toml:1: \"a\" is not an array of numbers");
  EXPECT_EQ(cause("a = [1]", [](TomlTable& t) { t.numbers("a", 3, 3, 0, 1); }),
            "f.toml:1: \"a\" has 1 elements, not 3");
  EXPECT_EQ(cause("a = [1,\n7]", [](TomlTable& t) { t.numbers("a", 1, 3, 0, 1); }),
            "f.toml:2: \"a\", element 2, is 7, outside [0, 1]");
  EXPECT_EQ(cause("a = ['x', 1]", [](TomlTable& t) { t.strings("a", 3); }),
            "f.toml:1: \"a\", element 2, is not a string");
  EXPECT_EQ(cause("a = [1]", [](TomlTable& t) { t.tables("a", 3); }),
            "f.toml:1: \"a\", element 1, is not a table");
}

TEST(TomlFile, CallersObjectionCarriesTheKeysLine) {
  TomlFile file = parsed("\n\na = 1\n");
  TomlTable root = file.root();
  root.number("a", 0, 1);
  root.reject("a", "too odd");
  EXPECT_EQ(problem(file), "f.toml:3: too odd");
}

TEST(TomlFile, SyntaxErrorsNameTheLineInOneLine) {
  for (const std::string text : {"a = 1\nb = = 2\n", "a = 1\na = 2\n", "a = 1\n\"b\n",
                                 "\nb = [1,\n", "\n\xff = 1\n", "\na = 1e999999x\n", "\n[a\n"}) {
    const std::string message = syntax_error(text);
    EXPECT_EQ(message.substr(0, 7), "f.toml:") << message;
    EXPECT_GE(message[7], '2') << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(TomlFile, LinesCountFromTheGivenFirstLine) {
  auto file = TomlFile::parse("\nx = 1\n", "t.hid", 10);
  ASSERT_TRUE(file);
  EXPECT_EQ(problem(*file), "t.hid:11: unknown key \"x\"");
  auto broken = TomlFile::parse("\nx = \n", "t.hid", 10);
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().message.substr(0, 9), "t.hid:11:");
}

TEST(TomlFile, KeysComeInTheOrderOfTheFile) {
  TomlFile file = parsed("z = 1\na = 2\n[m]\n");
  EXPECT_EQ(file.root().keys(), (std::vector<std::string>{"z", "a", "m"}));
  EXPECT_EQ(file.root().line("m"), 3);
}

TEST(TomlFile, DeepNestingIsRefusedAndNeverOverflowsTheStack) {
  std::string dotted = "[a";
  for (int i = 0; i < 400'000; ++i) dotted += ".a";
  EXPECT_EQ(syntax_error(dotted + "]\n"), "f.toml:1: a key of more than 16 parts");
  EXPECT_EQ(syntax_error("b = '#\"'\n" + dotted + "]\n!"), "f.toml:2: a key of more than 16 parts");
  // Dots in strings do not count, even if the strings look like separators.
  std::string in_strings = "x = \"\"\"a\"\"\"\"\"\ny = '''\n'''\na";
  for (int i = 0; i < 200'000; ++i) in_strings += ".'='";
  EXPECT_EQ(syntax_error(in_strings + " = 1"), "f.toml:4: a key of more than 16 parts");
  EXPECT_NE(syntax_error(std::string(400'000, '[')), "none");
  EXPECT_NE(syntax_error("a = " + std::string(400'000, '[')), "none");
  std::string inline_tables = "a = ";
  for (int i = 0; i < 50'000; ++i) inline_tables += "{a.b.c.d.e.f.g = ";
  EXPECT_NE(syntax_error(inline_tables), "none");
}

TEST(TomlFile, DotsInStringsCommentsAndNumbersAreNoKeyParts) {
  EXPECT_EQ(syntax_error("a = '................................'\n# ..........................\n"
                         "b = [0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1,\n"
                         " 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1]\n"
                         "c = \"\"\"\n \\\" \\\\ ..............................\n\"\"\"\n"),
            "none");
}

TEST(TomlFile, FilesThatCannotBeReadAreNamed) {
  const OwnFolder own;
  const std::string folder = own.path.string();
  EXPECT_EQ(TomlFile::load(folder + "/no").error().message, folder + "/no: no such file");
  EXPECT_EQ(TomlFile::load(folder).error().message, folder + ": not a regular file (a folder)");
  const std::string fifo = folder + "/fifo";
  mkfifo(fifo.c_str(), 0600);
  EXPECT_EQ(TomlFile::load(fifo).error().message, fifo + ": not a regular file (a FIFO)");
  const std::string big = own.write("big", std::string(kMaxTomlBytes + 1, '#'));
  EXPECT_EQ(TomlFile::load(big).error().message, big + ": larger than 1048576 bytes");
}

// Any bytes give a table or an error, never a crash.
TEST(TomlFile, DamagedFilesNeverThrow) {
  const std::string sound =
      "a = 1.5\n[b.c]\nd = ['x', \"y\\n\"]\n[[e]]\nf = {g = 1, h = 2020-01-01}\n";
  std::uint32_t seed = 1;
  for (int i = 0; i < 5'000; ++i) {
    std::string text = sound;
    for (int n = 0; n < 3; ++n) {
      seed = seed * 1664525u + 1013904223u;
      text[(seed >> 8) % text.size()] = static_cast<char>(seed >> 24);
    }
    auto file = TomlFile::parse(text, "f.toml");
    if (file) {
      file->root().table("b");
      file->root().tables("e", 4);
      file->problem();
    }
  }
}

TEST(TomlScan, InvalidUtf8IsFoundOnItsLine) {
  using namespace std::string_view_literals;
  EXPECT_EQ(line_of_invalid_utf8("a = '\u00e9\u20ac\U0001f6b6'\n"), 0);
  for (const auto bad : {"\x80"sv, "\xc0\x80"sv, "\xc3"sv, "\xc3("sv, "\xe0\x80\x80"sv,
                         "\xed\xa0\x80"sv, "\xf0\x80\x80\x80"sv, "\xf4\x90\x80\x80"sv, "\xff"sv}) {
    EXPECT_EQ(line_of_invalid_utf8("a\nb\n" + std::string(bad)), 3);
  }
}

TEST(TomlScan, StrayCharactersAreFoundOutsideStringsAndComments) {
  const std::string mark = "\ufeff";
  EXPECT_EQ(line_of_stray_character(mark + "a = '\u00e9' # \u00e9\nb = \"\u00e9\""), 0);
  EXPECT_EQ(line_of_stray_character("a = 1\n\u00e9 = 2\n"), 2);
  EXPECT_EQ(line_of_stray_character("\n\nk\ufef7ind = 1"), 3);
}

TEST(TomlScan, KeyPartsAreCountedFromDotsOutsideStringsAndComments) {
  const std::string many = "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a";
  EXPECT_EQ(line_of_overlong_key("\n" + many + " = 1"), 2);
  EXPECT_EQ(line_of_overlong_key("x = \"" + many + "\" # " + many), 0);
  EXPECT_EQ(line_of_overlong_key("x = \"\\\"" + many + "\"\n" + many), 2);
  EXPECT_EQ(line_of_overlong_key("x = '\\'\n" + many), 2);
  EXPECT_EQ(line_of_overlong_key("x = '''" + many + "'''''\n" + many), 2);
  EXPECT_EQ(line_of_overlong_key("x = \"\"\"\n\\\"\"\"" + many), 0);
}

}  // namespace
}  // namespace gaitpad
