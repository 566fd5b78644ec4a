#!/usr/bin/env bash
# vocab_test.sh PROGRAM SEQUENCE WORK: `ldso vocab` trains from whatever holds images, gives the same file for any number
# of threads, and says clearly what is wrong with damaged vocabularies and images.
LDSO=$1 SEQUENCE=$2 WORK=$3/vocab
rm -rf "$WORK" && mkdir -p "$WORK"
source "$(dirname "${BASH_SOURCE[0]}")/test_tools.sh"
small=(--depth 3 --features-per-image 200)

# A sequence with its calibration; a folder of images without any; single files.
expect_exit 0 vocab train "$SEQUENCE" -o "$WORK/a.ldsovoc" "${small[@]}" --stride 4 --threads 1
expect_output '^training: 100 %'
expect_output '^origin .*15 images'
mkdir "$WORK/plain"
find -L "$SEQUENCE/images" -type f | sort | sed -n 1,8p | xargs -I{} cp {} "$WORK/plain/"
mapfile -t files < <(find "$WORK/plain" -type f | sort | sed -n 1,3p)
expect_exit 0 vocab train "$WORK/plain" "${files[@]}" -o "$WORK/plain.ldsovoc" "${small[@]}"
expect_output '^origin .*11 images'

# The same bits for any number of threads, others for another seed.
expect_exit 0 vocab train "$SEQUENCE" -o "$WORK/b.ldsovoc" "${small[@]}" --stride 4 --threads 3 --quiet
[[ ! -s $WORK/log ]] || fail "--quiet has printed something"
cmp "$WORK/a.ldsovoc" "$WORK/b.ldsovoc" || fail "the vocabulary depends on the number of threads"
expect_exit 0 vocab train "$SEQUENCE" -o "$WORK/b.ldsovoc" "${small[@]}" --stride 4 --seed 2
if cmp -s "$WORK/a.ldsovoc" "$WORK/b.ldsovoc"; then fail "the seed does not matter"; fi

expect_exit 0 vocab info
expect_output '^vocabulary +\(built in\)'
expect_exit 0 vocab info "$WORK/a.ldsovoc"
expect_output '^words +[0-9]+'
expect_output '^origin +ldso vocab train --branching'

# A vocabulary of DBoW2, as it is and converted.
descriptor=$(printf '%d ' {1..32})
printf '2 1 0 0\n0 1 %s 1.5\n0 1 %s 2.5\n' "$descriptor" "${descriptor/1 /200 }" >"$WORK/dbow.txt"
expect_exit 0 vocab info "$WORK/dbow.txt"
expect_output '^words +2 '
expect_exit 0 vocab convert "$WORK/dbow.txt" -o "$WORK/converted.ldsovoc"
expect_exit 0 vocab info "$WORK/converted.ldsovoc"
expect_output '^weights +1\.500 \.\. 2\.500'
expect_output '^origin +DBoW2 text'

# Damaged vocabularies.
refused_file() {  # pattern
  expect_exit 1 vocab info "$WORK/bad"
  expect_output "^error: .*/bad.*$1"
}
refused_file 'cannot be opened'
: >"$WORK/bad"
refused_file 'the file is empty'
head -c 5000 "$WORK/a.ldsovoc" >"$WORK/bad"
refused_file 'truncated; copy it again'
cp "$WORK/a.ldsovoc" "$WORK/bad"
printf 'xyz' | dd of="$WORK/bad" bs=1 seek=4000 conv=notrunc status=none
refused_file 'damaged \(its checksum is wrong\); copy it again'
sed '2s/ 32 / 300 /' "$WORK/dbow.txt" >"$WORK/bad"
refused_file ':2: byte 32'
printf '\x81\x3f\x86\xb1\x14\x00\x00\x00\x01\x05\x00\x00\x00' >"$WORK/bad"
refused_file 'compressed'
echo "this is no vocabulary" >"$WORK/bad"
refused_file 'is no vocabulary'

# Input that cannot be trained from.
refused_training() {  # pattern, inputs
  expect_exit 1 vocab train "${@:2}" -o "$WORK/out.ldsovoc"
  expect_output "^error: .*$1"
  [[ ! -e $WORK/out.ldsovoc ]] || fail "a refused training has written a vocabulary"
}
mkdir "$WORK/empty"
refused_training 'the folder is empty' "$WORK/empty"
refused_training 'no such file or folder' "$WORK/missing"
refused_training 'at least two images' "${files[0]}"
expect_exit 1 vocab train "$WORK/plain" -o "$WORK/missing/out.ldsovoc"
expect_output '^error: .*out\.ldsovoc.*folder of the output does not exist'
expect_exit 1 vocab train "$WORK/plain" -o "$WORK/out.ldsovoc" --branching 1
expect_output '^error: .*--branching.*ldso vocab train --help'
expect_exit 1 vocab trian "$WORK/plain"
expect_output '^error: .*ldso vocab --help'
expect_exit 1 vocab train "$WORK/plain" -o "$WORK/out.ldsovoc" --dept 3
expect_output 'unknown option --dept; did you mean --depth\?'

# One unreadable image of many is left out.
echo "this is no image" >"${files[1]}"
expect_exit 0 vocab train "$WORK/plain" -o "$WORK/out.ldsovoc" "${small[@]}"
expect_output "^warning: an image is left out: .*$(basename "${files[1]}")"
expect_output '^origin .*7 images'
