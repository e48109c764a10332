# Cases of straight tubes of radius 2 mm along x, from 0 to 60 mm, and one without models, into FOLDER. shifted.lumen is the
# tube, which in a second goes 3 mm along y and shrinks to .9 of its radius; bent.lumen bends by 8 mm at its end,
# and struck.lumen does in a tenth of the time.
file(MAKE_DIRECTORY ${FOLDER})

# add_tube(VARIABLE Y FIRST): the lines of a tube at Y in SWC, its nodes counted from FIRST
function(add_tube variable y first)
  set(lines "${${variable}}")
  set(parent -1)
  foreach(i RANGE 30)
    math(EXPR node "${first} + ${i}")
    math(EXPR x "2 * ${i}")
    string(APPEND lines "${node} 0 ${x} ${y} 0 2 ${parent}\n")
    set(parent ${node})
  endforeach()
  set(${variable} "${lines}" PARENT_SCOPE)
endfunction()

add_tube(tube 0 1)
file(WRITE ${FOLDER}/tube.swc "${tube}")
add_tube(touching 0 1)
add_tube(touching 3.9 32)
file(WRITE ${FOLDER}/touching.swc "${touching}")
foreach(name tube touching)
  execute_process(COMMAND ${LUMEN} convert ${FOLDER}/${name}.swc ${FOLDER}/${name}.lumen --quiet COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# Lists of all nodes. Bent: y = x^2 / 450; the sine of half the slope in thousandths.
foreach(i RANGE 30)
  math(EXPR x "2 * ${i}")
  math(EXPR y "${x} * ${x} * 1000 / 450")
  math(EXPR sine "${x} * 1000 / 450")
  math(EXPR cosine "1000000 - ${sine} * ${sine} / 2")
  list(APPEND nodes ${i})
  list(APPEND rest "[${x},0,0]")
  list(APPEND shifted "[${x},3,0]")
  list(APPEND bent "[${x},${y}e-3,0]")
  list(APPEND upright "[0,0,0,1]")
  list(APPEND turned "[0,0,${sine}e-3,${cosine}e-6]")
  list(APPEND smaller 0.9)
  list(APPEND ones 1)
endforeach()
# add_motion(NAME SECONDS CENTRES ROTATIONS FACTORS): the tube, whose nodes get there from their rest in that time
execute_process(COMMAND ${LUMEN} convert ${FOLDER}/tube.lumen ${FOLDER}/tube.lumen.json --quiet COMMAND_ERROR_IS_FATAL ANY)
file(READ ${FOLDER}/tube.lumen.json tube_text)
function(add_motion name seconds centres rotations factors)
  string(CONCAT motion "\"motion\": {\"time\": [0, ${seconds}], \"node\": [${nodes}], \"centre\": [[${rest}], [${centres}]], "
    "\"rotation\": [[${upright}], [${rotations}]], \"factor\": [[${ones}], [${factors}]]},\n")
  string(REPLACE ";" "," motion "${motion}")
  string(REPLACE "\"tree\": {" "${motion}  \"tree\": {" text "${tube_text}")
  string(REGEX REPLACE "\"version\": \"1.[0-9]\"" "\"version\": \"1.2\"" text "${text}")
  file(WRITE ${FOLDER}/${name}.lumen.json "${text}")
  execute_process(COMMAND ${LUMEN} convert ${FOLDER}/${name}.lumen.json ${FOLDER}/${name}.lumen --quiet COMMAND_ERROR_IS_FATAL ANY)
endfunction()

add_motion(shifted 1 "${shifted}" "${upright}" "${smaller}")
add_motion(bent 1 "${bent}" "${turned}" "${ones}")
add_motion(struck 0.1 "${bent}" "${turned}" "${ones}")

set(phantom ${FOLDER}/unfitted)
execute_process(COMMAND ${LUMEN} phantom tube ${phantom}.nrrd --size 48 --seeds ${phantom}.json --quiet COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${LUMEN} track ${phantom}.nrrd ${phantom}.lumen --seeds ${phantom}.json --seeds-only --quiet COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${FOLDER}/broken.lumen "no case at all, but more than nothing")
