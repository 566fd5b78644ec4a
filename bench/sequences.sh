# To be sourced: the sequences that measurements run over.

# One "name|folder" a line: of LDSO_DATA 7scenes_kitchen and kitti/sequences/{00,05,06}, of LDSO_SIM every folder with a
# times.txt.
list_sequences() {
  local number folder times
  if [[ -n ${LDSO_DATA:-} ]]; then
    if [[ -d $LDSO_DATA/7scenes_kitchen ]]; then echo "7scenes_kitchen|$LDSO_DATA/7scenes_kitchen"; fi
    for number in 00 05 06; do
      folder=$LDSO_DATA/kitti/sequences/$number
      if [[ -d $folder ]]; then echo "kitti_$number|$folder"; fi
    done
  fi
  if [[ -n ${LDSO_SIM:-} ]]; then
    for times in "$LDSO_SIM"/*/times.txt; do
      [[ -f $times ]] || continue
      folder=$(dirname "$times")
      echo "$(basename "$folder")|$folder"
    done
  fi
}
