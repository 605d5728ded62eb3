// The text of the code editor: every edit, moves, its history, and random edits with undo to the start.
#include <gtest/gtest.h>

#include <random>

#include "editor/code/colouring.h"
#include "editor/code/edits.h"

namespace fw::editor::test::code_text_test {

using namespace fw::editor::code;

/// A text with its cursor at '|', and its anchor at '[' or ']' where it has one.
Text marked(const std::string& words) {
    std::string plain;
    std::size_t cursor = 0, anchor = std::string::npos;
    for (const char c : words) {
        if (c == '|')
            cursor = plain.size();
        else if (c == '^')
            anchor = plain.size();
        else
            plain += c;
    }
    Text text = textOf(plain);
    place(text, spotOf(text, anchor == std::string::npos ? cursor : anchor));
    place(text, spotOf(text, cursor), true);
    return text;
}

/// The same of a text: '|' the cursor, '^' the other end of a selection.
std::string shown(const Text& text) {
    std::string words = stringOf(text);
    const std::size_t cursor = offsetOf(text, text.cursor), anchor = offsetOf(text, text.anchor);
    if (anchor > cursor) words.insert(anchor, "^");
    words.insert(cursor, "|");
    if (anchor < cursor) words.insert(anchor, "^");
    return words;
}

template <class Edit>
std::string edited(const std::string& words, const Edit& edit) {
    Text text = marked(words);
    edit(text);
    // Every edit is a step that comes back.
    const std::string made = shown(text);
    if (stringOf(text) != stringOf(marked(words))) {
        EXPECT_TRUE(undo(text));
        EXPECT_EQ(shown(text), shown(marked(words))) << "undone";
        EXPECT_FALSE(undo(text)) << "one step";
        EXPECT_TRUE(redo(text));
        const std::string plain = made;
        std::string text2 = stringOf(text), wanted;
        for (const char c : plain)
            if (c != '|' && c != '^') wanted += c;
        EXPECT_EQ(text2, wanted) << "done again";
    }
    return made;
}

TEST(CodeText, KeepsLinesAndCharacters) {
    const Text text = textOf("añb\r\n\tx\n");
    EXPECT_EQ(text.lines, (std::vector<std::string>{"añb", "\tx", ""}));
    EXPECT_EQ(stringOf(text), "añb\n\tx\n");
    EXPECT_TRUE(is(text, "añb\n\tx\n"));
    for (const char* other : {"", "añb", "añb\n\tx", "añb\n\tx\n\n", "añb\n\ty\n"})
        EXPECT_FALSE(is(text, other));
    EXPECT_EQ(code::after(text, {0, 1}), (Spot{0, 3})) << "ñ has two bytes";
    EXPECT_EQ(before(text, {0, 3}), (Spot{0, 1}));
    EXPECT_EQ(before(text, {1, 0}), (Spot{0, 4}));
    EXPECT_EQ(code::after(text, {0, 4}), (Spot{1, 0}));
    EXPECT_EQ(clamped(text, {0, 2}), (Spot{0, 1}));
    EXPECT_EQ(clamped(text, {9, 9}), endOf(text));
    EXPECT_EQ(columnOf(text, {0, 4}), 3);
    EXPECT_EQ(columnOf(text, {1, 1}), kTabWidth);
    EXPECT_EQ(spotAt(text, 0, 2.4f), (Spot{0, 3}));
    EXPECT_EQ(spotOfPlace(text, 1, 3), (Spot{0, 3}));
    for (std::size_t i = 0; i <= stringOf(text).size(); ++i)
        EXPECT_EQ(offsetOf(text, spotOf(text, i)), i == 2 ? 1 : i) << "never inside of a character";
}

TEST(CodeEdits, TypesInPlaceOfTheSelection) {
    EXPECT_EQ(edited("a|c", [](Text& t) { type(t, "b", 0); }), "ab|c");
    EXPECT_EQ(edited("a^xyz|c", [](Text& t) { type(t, "ñ", 0); }), "añ|c");
    EXPECT_EQ(edited("a|x\ny^c", [](Text& t) { type(t, "b", 0); }), "ab|c");
    EXPECT_EQ(edited("    {\n        |", [](Text& t) { type(t, "}", 0); }), "    {\n    }|") << "goes back";
    EXPECT_EQ(edited("  f(|", [](Text& t) { type(t, "}", 0); }), "  f(}|") << "it is not the first";
}

TEST(CodeEdits, EndsLinesWithTheirIndentation) {
    EXPECT_EQ(edited("    a|b", breakLine), "    a\n    |b");
    EXPECT_EQ(edited("for (;;) {|", breakLine), "for (;;) {\n    |");
    EXPECT_EQ(edited("  if (a) {|}", breakLine), "  if (a) {\n      |\n  }");
    EXPECT_EQ(edited("    |", breakLine), "    \n    |");
    EXPECT_EQ(edited("a| b", breakLine), "a\n|b");
}

TEST(CodeEdits, Erases) {
    EXPECT_EQ(edited("añ|b", [](Text& t) { eraseBack(t, false, 0); }), "a|b");
    EXPECT_EQ(edited("a|ñb", [](Text& t) { eraseForward(t, false, 0); }), "a|b");
    EXPECT_EQ(edited("a\n|b", [](Text& t) { eraseBack(t, false, 0); }), "a|b");
    EXPECT_EQ(edited("a|\nb", [](Text& t) { eraseForward(t, false, 0); }), "a|b");
    EXPECT_EQ(edited("      |b", [](Text& t) { eraseBack(t, false, 0); }), "    |b") << "one indentation";
    EXPECT_EQ(edited("max(a_b|c", [](Text& t) { eraseBack(t, true, 0); }), "max(|c");
    EXPECT_EQ(edited("|max(ab", [](Text& t) { eraseForward(t, true, 0); }), "|(ab");
    EXPECT_EQ(edited("a^bc|d", [](Text& t) { eraseForward(t, true, 0); }), "a|d");
    EXPECT_EQ(edited("|ab", [](Text& t) { eraseBack(t, false, 0); }), "|ab");
}

TEST(CodeEdits, Indents) {
    EXPECT_EQ(edited("a|b", indent), "a   |b");
    EXPECT_EQ(edited("^a\nb|", indent), "^    a\n    b|");
    EXPECT_EQ(edited("^a\n|b", indent), "^    a\n|b") << "it ends before the second";
    EXPECT_EQ(edited("      a|", outdent), "  a|");
    EXPECT_EQ(edited("^  a\n\n      b|", outdent), "^a\n\n  b|");
    EXPECT_EQ(edited("\ta|", outdent), "a|");
}

TEST(CodeEdits, TogglesComments) {
    EXPECT_EQ(edited("  a|", toggleComment), "  // a|");
    EXPECT_EQ(edited("  // a|", toggleComment), "  a|");
    EXPECT_EQ(edited("  //a|", toggleComment), "  a|");
    EXPECT_EQ(edited("^  a\n\n    b|", toggleComment), "^  // a\n\n  //   b|") << "one column for all";
    EXPECT_EQ(edited("^  // a\n  b|", toggleComment), "^  // // a\n  // b|") << "not all have it";
}

TEST(CodeEdits, MovesAndDoublesLines) {
    EXPECT_EQ(edited("a\nb|\nc", [](Text& t) { moveLines(t, -1); }), "b|\na\nc");
    EXPECT_EQ(edited("a\nb|\nc", [](Text& t) { moveLines(t, 1); }), "a\nc\nb|");
    EXPECT_EQ(edited("|a\nb", [](Text& t) { moveLines(t, -1); }), "|a\nb");
    EXPECT_EQ(edited("^a\nb|\nc", [](Text& t) { moveLines(t, 1); }), "c\n^a\nb|");
    EXPECT_EQ(edited("a\nb|c\nd", code::duplicate), "a\nbc\nb|c\nd");
    EXPECT_EQ(edited("x^ab|y", code::duplicate), "xab^ab|y");
}

TEST(CodeEdits, CutsAndPastes) {
    Text text = marked("a\nb|c\nd");
    EXPECT_EQ(copied(text), "bc\n");
    EXPECT_EQ(cut(text), "bc\n");
    EXPECT_EQ(shown(text), "a\n|d");
    text = marked("a\nlast|");
    EXPECT_EQ(cut(text), "last\n");
    EXPECT_EQ(shown(text), "a|");
    text = marked("a^bc|d");
    EXPECT_EQ(cut(text), "bc");
    EXPECT_EQ(shown(text), "a|d");
    EXPECT_EQ(edited("a^b|", [](Text& t) { paste(t, "x\r\n\ty"); }), "ax\n    y|");
}

TEST(CodeEdits, MovesByCharactersWordsAndLines) {
    const auto moved = [](const std::string& words, Move by, bool selecting = false) {
        Text text = marked(words);
        move(text, by, selecting, 2);
        return shown(text);
    };
    EXPECT_EQ(moved("a|\nb", Move::right), "a\n|b");
    EXPECT_EQ(moved("a^bc|d", Move::left), "a|bcd") << "to the selection's end";
    EXPECT_EQ(moved("a^bc|d", Move::right), "abc|d");
    EXPECT_EQ(moved("a|b", Move::right, true), "a^b|");
    EXPECT_EQ(moved("foo bar|", Move::wordLeft), "foo |bar");
    EXPECT_EQ(moved("|foo  bar", Move::wordRight), "foo  |bar");
    EXPECT_EQ(moved("größe|.x", Move::wordLeft), "|größe.x");
    EXPECT_EQ(moved("  ab|c", Move::lineStart), "  |abc");
    EXPECT_EQ(moved("  |abc", Move::lineStart), "|  abc");
    EXPECT_EQ(moved("|abc\nd", Move::lineEnd), "abc|\nd");
    EXPECT_EQ(moved("a\nb\nc\nd|", Move::pageUp), "a\nb|\nc\nd");
    EXPECT_EQ(moved("ab|c\nd", Move::up), "|abc\nd");
    EXPECT_EQ(moved("a\nb|", Move::textStart, true), "|a\nb^");

    Text text = marked("abcdef|\nx\nabcdef");
    move(text, Move::down, false);
    EXPECT_EQ(shown(text), "abcdef\nx|\nabcdef");
    move(text, Move::down, false);
    EXPECT_EQ(shown(text), "abcdef\nx\nabcdef|") << "the column is kept";
}

TEST(CodeEdits, SelectsWordsAndLines) {
    Text text = textOf("max(größe, 2)\nb");
    select(text, wordAt(text, {0, 6}));
    EXPECT_EQ(copied(text), "größe");
    select(text, wordAt(text, {0, 3}));
    EXPECT_EQ(copied(text), "max") << "between a word and a sign";
    select(text, lineAt(text, 0));
    EXPECT_EQ(copied(text), "max(größe, 2)\n");
    selectAll(text);
    EXPECT_EQ(copied(text), stringOf(text));
}

TEST(CodeHistory, StepsAreWordsAndRests) {
    Text text;
    double seconds = 0;
    for (const char c : std::string("one two")) type(text, std::string(1, c), seconds += 0.1);
    const auto back = [&] {
        EXPECT_TRUE(undo(text));
        return stringOf(text);
    };
    EXPECT_EQ(back(), "one ");
    EXPECT_EQ(back(), "one");
    EXPECT_EQ(back(), "");
    EXPECT_FALSE(undo(text));
    while (redo(text)) {}
    EXPECT_EQ(stringOf(text), "one two");
    type(text, "a", seconds += 0.1);
    type(text, "b", seconds += 5.0);  // after a rest
    EXPECT_EQ(back(), "one twoa");
    for (int i = 0; i < 4; ++i) eraseBack(text, false, seconds += 0.1);
    EXPECT_EQ(stringOf(text), "one ");
    EXPECT_EQ(back(), "one twoa") << "held, it is one step";
    EXPECT_FALSE(redo(text) && redo(text));
}

TEST(CodeFind, GoesRound) {
    Text text = textOf("Ab ab\nxab");
    const auto at = [&](bool backward, const char* words = "ab") {
        const auto found = find(text, words, backward);
        if (!found) return std::string("none");
        select(text, *found);
        return std::to_string(found->from.line) + ":" + std::to_string(found->from.byte);
    };
    EXPECT_EQ(at(false), "0:0");
    EXPECT_EQ(at(false), "0:3");
    EXPECT_EQ(at(false), "1:1");
    EXPECT_EQ(at(false), "0:0");
    EXPECT_EQ(at(true), "1:1");
    EXPECT_EQ(at(false, "Ab"), "0:0") << "capitals matter where there are some";
    EXPECT_EQ(at(false, "Ab"), "0:0");
    EXPECT_EQ(at(false, "abc"), "none");
    EXPECT_EQ(findAll(text, "ab", 0, 5).size(), 3u);
}

bool isWhole(const Text& text) {
    for (const std::string& line : text.lines)
        for (std::size_t i = 0; i < line.size();) {
            const auto lead = static_cast<unsigned char>(line[i]);
            const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
            if ((lead & 0xC0) == 0x80 || i + length > line.size()) return false;
            for (std::size_t k = 1; k < length; ++k)
                if ((line[i + k] & 0xC0) != 0x80) return false;
            i += length;
        }
    return text.cursor == clamped(text, text.cursor) && text.anchor == clamped(text, text.anchor);
}

TEST(CodeHistory, RandomEditsAreUndoneToTheStart) {
    const unsigned seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto below = [&](int n) { return int(random() % unsigned(n)); };
    const std::string words[] = {"max(", "}",  " ",  "ñ",  "€x", "vec3 a = 1;\n", "{\n", "/*", "*/",
                                 "\"",   "//", "\t", "\n", "𝄞",  "1.5e3",         ")",   "p.x"};
    const int rounds = std::getenv("FIELDWRIGHT_LONG") ? 400 : 40;
    for (int round = 0; round < rounds; ++round) {
        std::string start;
        for (int i = below(30); i > 0; --i) start += words[below(int(std::size(words)))];
        Text text = textOf(start);
        Colouring colouring;
        for (int step = 0; step < 120; ++step) {
            const std::string& word = words[below(int(std::size(words)))];
            const bool flag = below(2) == 0;
            switch (below(16)) {
                case 0:
                case 1:
                case 2: type(text, word, step * 0.3); break;
                case 3: breakLine(text); break;
                case 4: eraseBack(text, flag, step * 0.3); break;
                case 5: eraseForward(text, flag, step * 0.3); break;
                case 6: flag ? indent(text) : outdent(text); break;
                case 7: toggleComment(text); break;
                case 8: moveLines(text, flag ? 1 : -1); break;
                case 9: duplicate(text); break;
                case 10: paste(text, word + word); break;
                case 11: cut(text); break;
                case 12: flag ? undo(text) : redo(text); break;
                case 13: select(text, wordAt(text, spotOf(text, std::size_t(below(200))))); break;
                default: move(text, Move(below(int(Move::textEnd) + 1)), flag, 3); break;
            }
            ASSERT_TRUE(isWhole(text));
            if (below(4) > 0) continue;
            // What was coloured by parts is as what is coloured anew.
            Colouring anew;
            for (int i = 0; i < int(text.lines.size()); ++i) {
                const std::vector<Stretch> parts = colouring.line(text, i);
                const std::vector<Stretch>& whole = anew.line(text, i);
                ASSERT_EQ(parts.size(), whole.size()) << "line " << i << " of\n" << stringOf(text);
                for (std::size_t k = 0; k < parts.size(); ++k) {
                    ASSERT_EQ(parts[k].begin, whole[k].begin);
                    ASSERT_EQ(parts[k].length, whole[k].length);
                    ASSERT_EQ(parts[k].ink, whole[k].ink);
                }
            }
        }
        const std::string end = stringOf(text);
        while (redo(text)) {}
        const std::string last = stringOf(text);
        while (undo(text)) {}
        ASSERT_EQ(stringOf(text), start);
        while (redo(text)) {}
        ASSERT_EQ(stringOf(text), last);
        (void)end;
    }
}

}  // namespace fw::editor::test::code_text_test
