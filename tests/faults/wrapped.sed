# SPDX-License-Identifier: MIT
# The symbols that calls.def names, for the linker's --wrap: sed -nEf wrapped.sed calls.def
s/^(CALL|AFTER|TEXT)\(([^,]*), ([a-z_0-9]+), .*/\3/p
s/^OWN\((.*)\)/\1/p
s/^(GL|GL_VOID|OWN_GL)\(([^,]*, )?(e?gl[A-Z][A-Za-z0-9]+)[,)].*/epoxy_\3/p
