// SPDX-License-Identifier: MIT
#include "base/c_locale.h"

#include <pthread.h>

static locale_t plain;

static void make(void)
{
    plain = newlocale(LC_ALL_MASK, "C", (locale_t)0); // takes no memory
}

locale_t c_locale_enter(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make);
    return uselocale(plain);
}

void c_locale_leave(locale_t before)
{
    uselocale(before);
}
