// A scene file with one mistake, and what is to be said of it.
#pragma once

#include <gmock/gmock.h>

#include <ostream>
#include <string>

#include "tests/unit/scene/scene_file.h"

namespace intaglio::scene {

struct Mistake {
    const char* name;
    std::string text;
    std::string message;  // part of it
    std::string code;
    int line, column;
};

inline void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

inline std::string mistake_name(const ::testing::TestParamInfo<Mistake>& mistake) {
    return mistake.param.name;
}

// One sentence that is the user's fault, with its code and its place in the file.
inline void expect_told(const Diagnostic& error, const Mistake& mistake, const SceneFile& file) {
    EXPECT_EQ(error.code, mistake.code) << to_string(error);
    EXPECT_THAT(error.message, ::testing::HasSubstr(mistake.message));
    EXPECT_EQ(error.file, file.path().string());
    EXPECT_EQ(error.line, mistake.line) << to_string(error);
    EXPECT_EQ(error.column, mistake.column) << to_string(error);
    EXPECT_EQ(error.fault, Fault::Input);
    EXPECT_THAT(error.message, ::testing::Not(::testing::HasSubstr("\n")));
    ASSERT_FALSE(error.message.empty());
    EXPECT_NE(error.message.back(), '.');
}

}  // namespace intaglio::scene
