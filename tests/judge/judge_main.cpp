// main() of the test programs that need the judge: without one they run nothing, say why, and exit
// with 77, which ctest reports as "not run".
#include <cstdio>
#include <string>

#include <gmock/gmock.h>

#include "tests/judge/judge.h"

int main(int count, char** words) {
    testing::InitGoogleMock(&count, words);
    std::string why;
    if (!intaglio::judge::find(&why)) {
        std::printf("not run: %s\n", why.c_str());
        return 77;
    }
    return RUN_ALL_TESTS();
}
