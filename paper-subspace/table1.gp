set datafile separator ','
set datafile missing 'nan'
set terminal svg noenhanced size 1740,900 font 'sans,13' background 'white'
set output 'table1.svg'
set multiplot layout 2,1 title 'Table 1: intersections relative to no culling' font ',16'
set style data histograms
set style histogram clustered gap 1.5
set style fill solid 0.9 noborder
set grid ytics lc rgb '#dddddd'
set yrange [0:100]
set ylabel 'intersections, % of no culling'
set xtics rotate by -35 font ',10'
set key outside right top samplen 2 font ',10'
colors = '#1f77b4 #2ca02c #98df8a #d62728 #ff7f0e #ff9896'
title_of(i) = i == 1 ? 'ideal' : i == 2 ? 'R_ray = R' : i == 3 ? 'R_ray = 2R' : i == 4 ? '256, per node' : i == 5 ? '256, summed' : '256, ours'
width = 1.0 / 7.5
do for [r = 4:6:2] {
  set title sprintf('R = %d (dots: published)', r)
  file = sprintf('< awk -F, ''NR > 1 && $2 == %d'' table1.csv', r)
  plot for [i = 1:6] file using (column(i + 2)):xtic(1) lc rgb word(colors, i) title title_of(i), \
       for [i = 1:4] file using ($0 + (i - 3.5) * width):(column(i + 8)) with points pt 7 ps 0.5 lc rgb 'black' \
         title (i == 1 ? 'published' : '')
}
unset multiplot
