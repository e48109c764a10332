# Cases of straight tubes of radius 2 mm along x, from 0 to 60 mm, and one without models, into FOLDER.
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

set(phantom ${FOLDER}/unfitted)
execute_process(COMMAND ${LUMEN} phantom tube ${phantom}.nrrd --size 48 --seeds ${phantom}.json --quiet COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${LUMEN} track ${phantom}.nrrd ${phantom}.lumen --seeds ${phantom}.json --seeds-only --quiet COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${FOLDER}/broken.lumen "no case at all, but more than nothing")
