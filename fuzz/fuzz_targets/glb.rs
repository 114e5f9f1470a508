#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| avatar_fuzz::glb(data));

libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    avatar_fuzz::mutate_json(data, size, max_size, seed, libfuzzer_sys::fuzzer_mutate)
});
