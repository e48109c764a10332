# A quantity at an end, over the second cycle of the heart: its mean, and how far the second half of the cycle
# differs from that of the first, as a share of the range. Equal halves end in equal states, so the flow is periodic.
/^#/ { next }
{ ++n; time[n] = $1; value[n] = $2 }
END {
  period = {period}
  before = 1
  least = most = ""
  for (i = 2; i <= n; ++i) {
    if (time[i] <= period) continue
    begin = time[i - 1] < period ? period : time[i - 1]
    step = time[i] - begin
    covered += step
    sum += step * (value[i] + value[i - 1]) / 2
    if (least == "" || value[i] < least) least = value[i]
    if (most == "" || value[i] > most) most = value[i]
    if (time[i] < 1.5 * period) continue
    then = time[i] - period
    while (time[before + 1] < then) ++before
    share = (then - time[before]) / (time[before + 1] - time[before])
    difference = value[i] - (value[before] + share * (value[before + 1] - value[before]))
    if (difference < 0) difference = -difference
    if (difference > greatest) greatest = difference
  }
  range = most - least
  printf "%.8g %.3g\n", sum / covered, range ? 100 * greatest / range : 0
}
