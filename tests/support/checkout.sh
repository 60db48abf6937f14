#!/bin/sh
# SPDX-License-Identifier: MIT
# Shared by the tests of documents, whose commands run in a copy of the files that they need. Source it instead of
# claims.sh.
. tests/support/claims.sh

# make_checkout: makes $work/checkout, with a program `small` that runs tractrix-render with smaller, simpler images and
# fewer frames.
make_checkout() {
    mkdir -p "$work/checkout/out"
    cp -r assets scripts "$work/checkout/"
    ln -s "$(realpath "$bin")" "$work/checkout/out/release"
    printf 'all:\n' >"$work/checkout/Makefile"

    # The last of equal flags applies. Scenes of docs/ get one frame, and so does an image without a number in its name.
    # Light is simple unless the example is about it: light among hair and exposure take most of the time of a small image.
    cat >"$work/checkout/small" <<END
#!/bin/sh
case " \$* " in
*--exposure* | *--tone*) ;;
*light* | *--look* | *--s[ckh]* | *--ground* | *--environment*) set -- "\$@" --exposure 0 ;;
*) set -- --look plain "\$@" --exposure 0 ;;
esac
frames="--frames 4"
case " \$* " in
*" --contact-sheet "* | *%*) ;;
*" --frames 1 "* | " docs/"* | *" docs/"*.json\ * | *.png\ *) frames= ;;
esac
# The field of a moving mesh is made again for every frame.
case " \$* " in
*" assets/nod.json "*) set -- "\$@" --sdf-resolution 24 ;;
esac
# shellcheck disable=SC2086 # words
exec "$(realpath "$bin")/tractrix-render" "\$@" --size 96x64 --followers 1 --smooth 1 --quality draft --preroll 0 \$frames
END
    chmod +x "$work/checkout/small"
}
