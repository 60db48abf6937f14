// SPDX-License-Identifier: MIT
// Linked into everything that CONFIG=sanitize and CONFIG=threads build: libraries stay loaded to
// the end. LeakSanitizer looks for leaks at exit and knows what it finds only by the library's name
// and data, and EGL has unloaded the driver by then. ThreadSanitizer gives up when a library of its
// suppressions is unloaded.
int dlclose(void *library);

int dlclose(void *library)
{
    (void)library;
    return 0;
}
